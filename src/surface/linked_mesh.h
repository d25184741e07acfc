// A closed mesh whose vertices know their neighbours on the faces of the grid's cells.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "parallel/executor.h"
#include "pliant/mesh.h"

namespace pliant::surface {

/// A position in a register.
struct alignas(16) Vertex {
  float x, y, z, unused;

  friend Vertex operator+(const Vertex& a, const Vertex& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z, a.unused + b.unused};
  }
  friend Vertex operator-(const Vertex& a, const Vertex& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z, a.unused - b.unused};
  }
  friend Vertex operator*(const Vertex& a, float s) { return {a.x * s, a.y * s, a.z * s, a.unused * s}; }
};

/// Each vertex lies on an edge of the grid. On each of the four faces at that edge the surface joins it to one other
/// vertex.
using Links = std::array<int, 4>;

struct LinkedMesh {
  int size = 0;  ///< number of vertices
  std::unique_ptr<Vertex[]> vertices;
  std::unique_ptr<Links[]> links;
  std::vector<std::array<int, 3>> triangles;
};

}  // namespace pliant::surface
