// The motion of a mesh collider's vertices: deformation by frames, then a rigid motion of the whole.
//
// The pose is computed once for all vertices, in double: a float's rounding error of position would appear as velocity.
#pragma once

#include <vector>

#include "math/motion.h"
#include "pliant/scene.h"

namespace pliant {

struct Carrier {
  Motion motion;
  std::vector<Vec3f> rest;                 ///< rest positions in storage order [m]
  std::vector<float> times;                ///< of the frames [s]; empty: no deformation
  std::vector<std::vector<Vec3f>> frames;  ///< positions in each frame, in storage order [m]
  bool repeat = false;

  bool deforms() const { return !times.empty(); }
  bool moves() const { return motion.moves() || deforms(); }
};

/// The pose of a Carrier at a time. It refers to the Carrier.
class CarrierPose {
 public:
  CarrierPose(const Carrier& carrier, double time);
  /// The same with a given pose instead of that of its motion.
  CarrierPose(const Carrier& carrier, double time, const Posed& pose);
  Vec3d place(int particle) const;

 private:
  Posed pose_;
  const std::vector<Vec3f>*before_, *after_;
  double share_ = 0;
};

/// Upper bound of any vertex's displacement between two times [m]: for a rigid mesh, that of its box's corners.
double largest_move(const Carrier& carrier, double from, double to);

/// A box.
struct CarrierBox {
  Vec3d low, high;
};

/// The bounding box of all vertices at a time.
CarrierBox box_at(const Carrier& carrier, double time);

}  // namespace pliant
