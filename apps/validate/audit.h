// An audit of every frame of a run: counts intersections, decided by exact predicates.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/queries.h"
#include "pliant/world.h"

namespace pliant::validate {

/// The result of an audit.
struct Audit {
  int frames = 0;
  int vertices = 0;      ///< vertices of all surfaces, with those of mesh colliders
  std::size_t most = 0;  ///< edges that cross or touch a triangle without a common vertex: largest number in a frame
  int first = -1;        ///< first frame with an intersection; -1: none
  std::int64_t unresolvable = 0;  ///< pairs that no step limit separates, summed over all frames
  double least_distance = 0;      ///< least distance in the frames in which it was measured [m]
  double ms = 0, slowest_ms = 0;  ///< processor time per frame: mean, maximum
  bool ok = true;                 ///< true if all values stayed finite
};

/// The triangles of all objects and mesh colliders of a World as one mesh.
class Surfaces {
 public:
  explicit Surfaces(const Scene& scene);

  /// Moves the mesh to the World's present state; the result is valid until the next call.
  const TriangleMesh& at(const World& world);
  const TriangleMesh& at_start() const { return mesh_; }

 private:
  TriangleMesh mesh_;
  int colliders_ = 0;
};

/// Simulates `frames` frames of a scene, and audits each.
Audit audit_surfaces(const Scene& scene, int frames);

/// Simulates a scene of one rope, and audits it. A rope has no sides, so each substep is made a frame: paths between
/// audits are then linear, and all pairs of links without a common end are tested along them. Audit::most counts the
/// pairs that meet in a frame.
Audit audit_rope(const Scene& scene, int frames);

}  // namespace pliant::validate
