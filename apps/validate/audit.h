// An exact look at every frame of a run: what meets what, judged by signs that rounding cannot change.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/queries.h"
#include "pliant/world.h"

namespace pliant::validate {

/// What was seen.
struct Audit {
  int frames = 0;
  int vertices = 0;      ///< of all surfaces, mesh colliders included
  std::size_t most = 0;  ///< in any one frame: edges that pass through a triangle or touch one without sharing a vertex
  int first = -1;        ///< the first frame of such; -1: none
  std::int64_t unresolvable = 0;  ///< summed over all frames
  double least_distance = 0;      ///< in the frames measured [m]
  double ms = 0, slowest_ms = 0;  ///< processor time of a frame: the mean, the largest
  bool ok = true;                 ///< nothing stopped being finite
};

/// All triangles of a World's objects and mesh colliders as one mesh.
class Surfaces {
 public:
  explicit Surfaces(const Scene& scene);

  /// As it is now: valid until the next call.
  const TriangleMesh& at(const World& world);
  const TriangleMesh& at_start() const { return mesh_; }

 private:
  TriangleMesh mesh_;
  int colliders_ = 0;
};

/// Runs a scene for `frames` frames and looks at each.
Audit audit_surfaces(const Scene& scene, int frames);

/// Runs a scene of one rope, in which links have no sides to be on: each substep is a frame of its own, so that particles
/// went straight from one look to the next, and paths of all pairs of links that share no end are tested for a meeting.
/// `most` counts them over a frame.
Audit audit_rope(const Scene& scene, int frames);

}  // namespace pliant::validate
