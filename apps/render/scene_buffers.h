// The triangles of a scene on the graphics card.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry.h"
#include "gl_objects.h"

namespace pliant::render {

/// Where a Geometry is in the vertex and index buffers.
struct Range {
  GLsizei count = 0;
  std::size_t first = 0;  // offset in the index buffer [bytes]
  Vec3f colour{};
  Material material = Material::solid;
  float clarity = 0;  // of what is clear [m]
  bool checked = false;
  std::size_t first_place = 0;  // offset in the buffer of places [bytes]
  GLsizei places = 0;
};

/// Vertex and index buffers of all geometries, and where each is in them.
class SceneBuffers {
 public:
  SceneBuffers();

  void upload(const std::vector<Geometry>& geometries);
  const std::vector<Range>& ranges() const { return ranges_; }
  bool has(Material material) const;
  bool has_clear() const { return has(Material::liquid) || has(Material::jelly); }
  /// Makes the vertex attributes current.
  void bind() const { glBindVertexArray(array_.get()); }
  /// Draws a range once, or at each of its places.
  void draw(const Range& range) const;

 private:
  VertexArray array_;
  Buffer vertices_, indices_, places_;
  std::vector<Range> ranges_;
};

}  // namespace pliant::render
