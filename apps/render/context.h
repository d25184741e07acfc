// An OpenGL 3.3 context without a window, through EGL.
#pragma once

#include <string>

namespace pliant::render {

class Context {
 public:
  /// Tries, in this order, a Mesa context without surface, a graphics card, and the default display. Throws Error naming
  /// the package that is missing.
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Directs OpenGL calls of this thread to it.
  void make_current() const;
  std::string device() const;

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace pliant::render
