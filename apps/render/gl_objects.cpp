// Makes shader programs, textures and framebuffers, and checks each.
#include "gl_objects.h"

#include "pliant/error.h"

namespace pliant::render {

namespace {

GLuint compile(GLenum kind, const std::string& source) {
  const GLuint shader = glCreateShader(kind);
  const char* const text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint fine = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &fine);
  if (fine) return shader;
  std::array<char, 2048> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteShader(shader);
  throw Error({}, std::string("the OpenGL driver rejects a shader: ") + log.data(), "update the driver");
}

}  // namespace

Program::Program(const std::string& vertex, const std::string& fragment) : name_(glCreateProgram()) {
  for (const auto& [kind, source] :
       {std::pair{GLenum{GL_VERTEX_SHADER}, &vertex}, {GLenum{GL_FRAGMENT_SHADER}, &fragment}}) {
    const GLuint shader = compile(kind, *source);
    glAttachShader(name_.get(), shader);
    glDeleteShader(shader);
  }
  glLinkProgram(name_.get());
  GLint fine = 0;
  glGetProgramiv(name_.get(), GL_LINK_STATUS, &fine);
  if (fine) return;
  std::array<char, 2048> log{};
  glGetProgramInfoLog(name_.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw Error({}, std::string("the OpenGL driver rejects a program: ") + log.data(), "update the driver");
}

Texture make_texture(GLint internal, int width, int height, GLenum format, GLenum type, GLint filter) {
  GLuint name = 0;
  glGenTextures(1, &name);
  Texture texture(name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexImage2D(GL_TEXTURE_2D, 0, internal, width, height, 0, format, type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

void require_complete() {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw Error({}, "the OpenGL driver cannot draw into a picture of this size", "choose a smaller size");
}

Framebuffer make_framebuffer(GLuint colour, GLuint depth) {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  Framebuffer framebuffer(name);
  glBindFramebuffer(GL_FRAMEBUFFER, name);
  if (colour != 0) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
  if (depth != 0) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  if (colour == 0) {
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
  }
  require_complete();
  return framebuffer;
}

SampledTarget::SampledTarget(int width, int height, int samples) {
  GLuint names[2] = {0, 0}, name = 0;
  glGenRenderbuffers(2, names);
  colour = Renderbuffer(names[0]);
  depth = Renderbuffer(names[1]);
  glGenFramebuffers(1, &name);
  framebuffer = Framebuffer(name);
  glBindFramebuffer(GL_FRAMEBUFFER, name);
  const auto attach = [&](GLuint buffer, GLenum format, GLenum place) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  };
  attach(names[0], GL_RGBA8, GL_COLOR_ATTACHMENT0);
  attach(names[1], GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
  require_complete();
}

}  // namespace pliant::render
