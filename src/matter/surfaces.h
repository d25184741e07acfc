// All surfaces that can have contact, at the start of a scene, as one mesh: for checks of the whole scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pliant/scene.h"
#include "topology/edges.h"

namespace pliant {

/// The surfaces of a scene. Parts are the objects, then the mesh colliders.
struct Surfaces {
  struct Part {
    std::string name;
    bool self, collides, is_collider;
    std::uint32_t groups, mask;
    int first = 0;           ///< index of its first vertex
    int first_triangle = 0;  ///< index of its first triangle in `triangles`
  };
  std::vector<Part> parts;
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;

  int part_of(int vertex) const;
  int end_of(int part) const;  ///< one past the last vertex of a part
  /// True if two parts can meet, by the rules of collision/proxies/pair_model.cpp.
  bool meet(int a, int b) const;
  std::string name(int part) const;  ///< name of a part for messages: "object 'shirt'"
  /// The index of a vertex within its part, as text.
  std::string local(int vertex) const { return std::to_string(vertex - parts[part_of(vertex)].first); }
  /// The triangles of a part, with vertex indices local to the part.
  std::vector<Triangle> triangles_of(int part) const;
};

/// Collects the surfaces at time 0 of a scene in which inspect() finds nothing grave.
Surfaces surfaces_of(const Scene& scene);

/// A mesh collider's vertex positions at time 0.
std::vector<Vec3f> positions_at_start(const MeshCollider& collider);

}  // namespace pliant
