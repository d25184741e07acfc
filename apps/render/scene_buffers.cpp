#include "scene_buffers.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace pliant::render {

SceneBuffers::SceneBuffers() {
  GLuint names[3];
  glGenVertexArrays(1, names);
  array_ = VertexArray(names[0]);
  glGenBuffers(3, names);
  vertices_ = Buffer(names[0]);
  indices_ = Buffer(names[1]);
  places_ = Buffer(names[2]);
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  for (GLuint i = 0; i < 2; ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), reinterpret_cast<const void*>(i * sizeof(Vec3f)));
  }
  glEnableVertexAttribArray(3);
  glVertexAttribPointer(3, 1, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                        reinterpret_cast<const void*>(offsetof(Vertex, shade)));
  glEnableVertexAttribArray(4);
  glVertexAttribPointer(4, 2, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                        reinterpret_cast<const void*>(offsetof(Vertex, checks)));
  glVertexAttribDivisor(2, 1);
}

void SceneBuffers::upload(const std::vector<Geometry>& geometries) {
  std::vector<Vertex> all_vertices;
  std::vector<std::uint32_t> all_indices;
  std::vector<std::array<float, 4>> all_places;
  ranges_.clear();
  for (const Geometry& geometry : geometries) {
    const auto first = static_cast<std::uint32_t>(all_vertices.size());
    ranges_.push_back({static_cast<GLsizei>(geometry.indices.size()), all_indices.size() * sizeof(std::uint32_t),
                       geometry.colour, geometry.material, geometry.clarity, geometry.checked,
                       all_places.size() * sizeof(all_places[0]), static_cast<GLsizei>(geometry.places.size())});
    all_places.insert(all_places.end(), geometry.places.begin(), geometry.places.end());
    all_vertices.insert(all_vertices.end(), geometry.vertices.begin(), geometry.vertices.end());
    for (const std::uint32_t i : geometry.indices) all_indices.push_back(first + i);
  }
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(all_vertices.size() * sizeof(Vertex)), all_vertices.data(),
               GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(all_indices.size() * sizeof(std::uint32_t)),
               all_indices.data(), GL_STREAM_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, places_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(all_places.size() * sizeof(all_places[0])), all_places.data(),
               GL_STREAM_DRAW);
}

bool SceneBuffers::has(Material material) const {
  return std::any_of(ranges_.begin(), ranges_.end(),
                     [material](const Range& range) { return range.material == material; });
}

void SceneBuffers::draw(const Range& range) const {
  const auto* const first = reinterpret_cast<const void*>(range.first);
  if (range.places == 0) {
    glDisableVertexAttribArray(2);
    glVertexAttrib4f(2, 0, 0, 0, 1);
    return glDrawElements(GL_TRIANGLES, range.count, GL_UNSIGNED_INT, first);
  }
  glBindBuffer(GL_ARRAY_BUFFER, places_.get());
  glVertexAttribPointer(2, 4, GL_FLOAT, GL_FALSE, 0, reinterpret_cast<const void*>(range.first_place));
  glEnableVertexAttribArray(2);
  glDrawElementsInstanced(GL_TRIANGLES, range.count, GL_UNSIGNED_INT, first, range.places);
}

}  // namespace pliant::render
