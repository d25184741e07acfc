// All contact geometry at the start of a scene, in one numbering, for checks of the whole scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pliant/scene.h"
#include "topology/edges.h"

namespace pliant {

/// Objects first, then mesh colliders.
struct Surfaces {
  struct Part {
    std::string name;
    bool self, collides, is_collider;
    std::uint32_t groups, mask;
    int first = 0;           ///< first vertex
    int first_triangle = 0;  ///< index in `triangles`
  };
  std::vector<Part> parts;
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;

  int part_of(int vertex) const;
  int end_of(int part) const;  ///< one past its last vertex
  /// True if two parts can meet, by the rules of collision/proxies/pair_model.cpp.
  bool meet(int a, int b) const;
  std::string name(int part) const;  ///< "object 'shirt'"
  /// A vertex index local to its part.
  std::string local(int vertex) const { return std::to_string(vertex - parts[part_of(vertex)].first); }
  /// The triangles of a part, in local vertex indices.
  std::vector<Triangle> triangles_of(int part) const;
};

/// The surfaces at time 0 of a scene without grave findings.
Surfaces surfaces_of(const Scene& scene);

/// A mesh collider's vertex positions at time 0.
std::vector<Vec3f> positions_at_start(const MeshCollider& collider);

}  // namespace pliant
