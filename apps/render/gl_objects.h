// OpenGL objects as values that delete them.
#pragma once

#include <epoxy/gl.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "matrix.h"

namespace pliant::render {

/// Owns the name of an OpenGL object and deletes it by `Delete`.
template <void (*Delete)(GLuint)>
class Name {
 public:
  explicit Name(GLuint name = 0) : name_(name) {}
  ~Name() {
    if (name_ != 0) Delete(name_);
  }
  Name(Name&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Name& operator=(Name&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  GLuint get() const { return name_; }

 private:
  GLuint name_;
};

inline void delete_texture(GLuint name) { glDeleteTextures(1, &name); }
inline void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void delete_renderbuffer(GLuint name) { glDeleteRenderbuffers(1, &name); }
inline void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void delete_sampler(GLuint name) { glDeleteSamplers(1, &name); }
inline void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void delete_program(GLuint name) { glDeleteProgram(name); }

using Texture = Name<delete_texture>;
using Framebuffer = Name<delete_framebuffer>;
using Renderbuffer = Name<delete_renderbuffer>;
using Buffer = Name<delete_buffer>;
using Sampler = Name<delete_sampler>;
using VertexArray = Name<delete_vertex_array>;

/// A shader program. Throws an Error with the driver's message if the GLSL source does not compile.
class Program {
 public:
  Program(const std::string& vertex, const std::string& fragment);

  void use() const { glUseProgram(name_.get()); }
  void set(const char* name, int value) const { glUniform1i(at(name), value); }
  void set(const char* name, float value) const { glUniform1f(at(name), value); }
  void set(const char* name, float x, float y) const { glUniform2f(at(name), x, y); }
  void set(const char* name, const Vec3f& v) const { glUniform3f(at(name), v.x, v.y, v.z); }
  void set(const char* name, const std::vector<std::pair<float, float>>& list) const {
    static_assert(sizeof(std::pair<float, float>) == 2 * sizeof(float));
    glUniform2fv(at(name), static_cast<GLsizei>(list.size()), &list.front().first);
  }
  void set(const char* name, const Matrix& m) const { glUniformMatrix4fv(at(name), 1, GL_FALSE, m.data()); }

 private:
  GLint at(const char* name) const { return glGetUniformLocation(name_.get(), name); }
  Name<delete_program> name_;
};

/// Makes a texture with one level and coordinates clamped to its edge; `filter` is GL_NEAREST or GL_LINEAR.
Texture make_texture(GLint internal, int width, int height, GLenum format, GLenum type, GLint filter);

/// Makes a framebuffer with a colour and a depth texture; 0: none. Throws an Error if OpenGL calls it incomplete.
Framebuffer make_framebuffer(GLuint colour, GLuint depth);

/// A texture, and the framebuffer that draws into it.
struct Target {
  Texture texture;
  Framebuffer framebuffer;
};

/// The target that draws colours into a texture.
inline Target colour_target(Texture texture) {
  Framebuffer framebuffer = make_framebuffer(texture.get(), 0);
  return {std::move(texture), std::move(framebuffer)};
}

/// A multisampled framebuffer. Its samples are averaged into another one later.
struct SampledTarget {
  Renderbuffer colour, depth;
  Framebuffer framebuffer;

  SampledTarget(int width, int height, int samples);
};

/// Throws an Error if OpenGL calls the bound framebuffer incomplete.
void require_complete();

}  // namespace pliant::render
