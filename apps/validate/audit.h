// An exact audit of every frame of a run: intersections, decided by exact predicates.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/queries.h"
#include "pliant/world.h"

namespace pliant::validate {

/// The result of an audit.
struct Audit {
  int frames = 0;
  int vertices = 0;      ///< number of vertices of all surfaces, including mesh colliders
  std::size_t most = 0;  ///< largest number of any frame: edges that cross a triangle or touch one without a common vertex
  int first = -1;        ///< the first frame with an intersection; -1: none
  std::int64_t unresolvable = 0;  ///< summed over all frames
  double least_distance = 0;      ///< over the measured frames [m]
  double ms = 0, slowest_ms = 0;  ///< processor time per frame: mean, maximum
  bool ok = true;                 ///< all values stayed finite
};

/// All triangles of a World's objects and mesh colliders as one mesh.
class Surfaces {
 public:
  explicit Surfaces(const Scene& scene);

  /// The surfaces in the World's current state; valid until the next call.
  const TriangleMesh& at(const World& world);
  const TriangleMesh& at_start() const { return mesh_; }

 private:
  TriangleMesh mesh_;
  int colliders_ = 0;
};

/// Runs a scene for `frames` frames and audits each.
Audit audit_surfaces(const Scene& scene, int frames);

/// Runs a scene of one rope, whose links have no sides that could be told apart.
/// Each substep is a frame, so paths between audits are linear. All pairs of links
/// without a common end are tested for a meeting; `most` counts them per frame.
Audit audit_rope(const Scene& scene, int frames);

}  // namespace pliant::validate
