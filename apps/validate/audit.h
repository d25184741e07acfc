// An exact look at every frame of a run: what meets what, judged by signs that rounding cannot change.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/untangle/intersections.h"
#include "pliant/world.h"

namespace pliant::validate {

/// What was seen.
struct Audit {
  int frames = 0;
  int vertices = 0;      ///< of all surfaces, mesh colliders included
  std::size_t most = 0;  ///< in any one frame: edges that pass through a triangle or touch one without sharing a vertex
  int first = -1;        ///< the first frame of such; -1: none
  std::int64_t hopeless = 0;      ///< summed over all frames
  double least_distance = 0;      ///< in the frames measured [m]
  double ms = 0, slowest_ms = 0;  ///< processor time of a frame: the mean, the largest
  bool ok = true;                 ///< nothing stopped being finite
};

/// All triangles of a World's objects and mesh colliders, numbered through.
class Surfaces {
 public:
  explicit Surfaces(const Scene& scene);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  int vertices() const { return vertices_; }
  /// Where they are now: valid until the next call [m].
  const std::vector<Vec3f>& places(const World& world);

 private:
  std::vector<Triangle> triangles_;
  std::vector<Vec3f> places_;
  int vertices_ = 0, colliders_ = 0;
};

/// Runs a scene for `frames` frames and looks at each.
Audit audit_surfaces(const Scene& scene, int frames);

/// Runs a scene of one rope, in which links have no sides to be on: each substep is a frame of its own, so that particles
/// went straight from one look to the next, and paths of all pairs of links that share no end are tested for a meeting.
/// `most` counts them over a frame.
Audit audit_rope(const Scene& scene, int frames);

/// The least distance of a vertex and a triangle or of two edges that share no vertex, where it is below `reach` [m]; else
/// `reach`.
double least_distance(const std::vector<Triangle>& triangles, const std::vector<Vec3f>& places, double reach);

}  // namespace pliant::validate
