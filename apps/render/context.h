// An OpenGL 3.3 context without a window, through EGL.
#pragma once

#include <string>

namespace pliant::render {

class Context {
 public:
  /// Tries, in this order, a Mesa context without a surface, a graphics card,
  /// and the default display. Throws an Error that names the missing package.
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes it current for the calling thread.
  void make_current() const;
  std::string device() const;

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace pliant::render
