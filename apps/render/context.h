// An OpenGL 3.3 context without a window, through EGL.
#pragma once

#include <string>

namespace pliant::render {

class Context {
 public:
  /// Tries a Mesa context without a surface, then a graphics card, then the default display. If all fail, throws an
  /// Error that names the missing package.
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Makes the context current for the calling thread.
  void make_current() const;
  std::string device() const;

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace pliant::render
