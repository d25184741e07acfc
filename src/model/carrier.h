// The motion of a mesh collider's vertices: deformation by keyframes, then a rigid motion of the whole mesh.
//
// The pose is computed once for all vertices, in double precision: float rounding of positions would appear as
// velocity.
#pragma once

#include <vector>

#include "math/motion.h"
#include "pliant/scene.h"

namespace pliant {

struct Carrier {
  Motion motion;
  std::vector<Vec3f> rest;                 ///< rest positions in storage order [m]
  std::vector<float> times;                ///< times of the keyframes [s]; empty: no deformation
  std::vector<std::vector<Vec3f>> frames;  ///< vertex positions at each keyframe, in storage order [m]
  bool repeat = false;

  bool deforms() const { return !times.empty(); }
  bool moves() const { return motion.moves() || deforms(); }
};

/// The pose of a mesh collider at a time. It keeps a reference to its Carrier.
class CarrierPose {
 public:
  CarrierPose(const Carrier& carrier, double time);
  /// A pose given by the user, which replaces that of the Carrier's motion.
  CarrierPose(const Carrier& carrier, double time, const Posed& pose);
  Vec3d place(int particle) const;

 private:
  Posed pose_;
  const std::vector<Vec3f>*before_, *after_;
  double share_ = 0;
};

/// Upper bound of any vertex's displacement between two times [m]; for a rigid mesh, that of its bounding box's
/// corners.
double largest_move(const Carrier& carrier, double from, double to);

/// An axis-aligned box in double precision [m].
struct CarrierBox {
  Vec3d low, high;
};

/// The bounding box of all vertices at a time.
CarrierBox box_at(const Carrier& carrier, double time);

}  // namespace pliant
