// What takes part in contact when a scene begins, in one numbering: for checks that look at all of it together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pliant/scene.h"
#include "topology/edges.h"

namespace pliant {

/// All objects, then all mesh colliders.
struct Surfaces {
  struct Part {
    std::string name;
    bool self, collides, is_collider;
    std::uint32_t groups, mask;
    int first = 0;           ///< vertex
    int first_triangle = 0;  ///< of `triangles`
  };
  std::vector<Part> parts;
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;

  int part_of(int vertex) const;
  int end_of(int part) const;  ///< one past its last vertex
  /// As collision/pair_model.cpp decides.
  bool meet(int a, int b) const;
  std::string name(int part) const;  ///< "object 'shirt'"
  /// A vertex in the numbers of its part.
  std::string local(int vertex) const { return std::to_string(vertex - parts[part_of(vertex)].first); }
  /// The triangles of a part, in local vertex indices.
  std::vector<Triangle> triangles_of(int part) const;
};

/// At time 0, of a scene in which nothing is grave.
Surfaces surfaces_of(const Scene& scene);

/// Where a mesh collider's vertices are at time 0.
std::vector<Vec3f> positions_at_start(const MeshCollider& collider);

}  // namespace pliant
