// Makes OpenGL contexts. epoxy aborts the program if a library is missing, so the libraries are looked for first.
#include "context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <vector>

#include "pliant/error.h"

namespace pliant::render {

namespace {

[[noreturn]] void fail(const std::string& problem, const std::string& advice) { throw Error({}, problem, advice); }

bool is_there(const char* library) {
  // The library is never closed, because epoxy keeps it open anyway.
  return ::dlopen(library, RTLD_LAZY | RTLD_LOCAL) != nullptr;
}

std::vector<EGLDisplay> displays() {
  std::vector<EGLDisplay> result;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
      result.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
        epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
      std::array<EGLDeviceEXT, 16> devices{};
      EGLint count = 0;
      if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) {
        for (EGLint i = 0; i < count; ++i)
          result.push_back(
              eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
      }
    }
  }
  result.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return result;
}

/// Makes an OpenGL 3.3 context current and returns it; EGL_NO_CONTEXT if the display has none.
EGLContext make_context(EGLDisplay display) {
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor)) return EGL_NO_CONTEXT;
  if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context") || !eglBindAPI(EGL_OPENGL_API))
    return EGL_NO_CONTEXT;
  const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, wanted.data(), &config, 1, &count) || count == 0) return EGL_NO_CONTEXT;
  const std::array<EGLint, 7> attributes{
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) return EGL_NO_CONTEXT;
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) && epoxy_gl_version() >= 33) return context;
  eglDestroyContext(display, context);
  return EGL_NO_CONTEXT;
}

}  // namespace

Context::Context() {
  if (!is_there("libEGL.so.1")) fail("pictures need EGL, which is not installed", "install the Debian package libegl1");
  if (!is_there("libOpenGL.so.0") && !is_there("libGL.so.1"))
    fail("pictures need OpenGL, which is not installed", "install the Debian packages libopengl0 and libgl1-mesa-dri");
  for (const EGLDisplay display : displays()) {
    context_ = make_context(display);
    display_ = display;
    if (context_ != EGL_NO_CONTEXT) return;
  }
  fail("EGL gives no OpenGL 3.3 context without a window",
       "install the Debian package libgl1-mesa-dri, which draws in software");
}

Context::~Context() {
  // The display is not closed, because all contexts of the program share it.
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

void Context::make_current() const {
  if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
    fail("the OpenGL context was lost", "try again");
}

std::string Context::device() const {
  make_current();
  const auto* const name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name != nullptr ? name : "unknown";
}

}  // namespace pliant::render
