// What carries the vertices of a mesh collider: frames that deform it, then a rigid motion of the whole.
//
// The pose is worked out once for all vertices, in double: what a float loses of a place would come back as a speed.
#pragma once

#include <vector>

#include "math/motion.h"
#include "pliant/scene.h"

namespace pliant {

struct Carrier {
  Motion motion;
  std::vector<Vec3f> rest;                 ///< in storage order [m]
  std::vector<float> times;                ///< of the frames [s]; empty: it does not deform
  std::vector<std::vector<Vec3f>> frames;  ///< in storage order [m]
  bool repeat = false;

  bool deforms() const { return !times.empty(); }
  bool moves() const { return motion.moves() || deforms(); }
};

/// A Carrier at a time, which it must not outlive.
class CarrierPose {
 public:
  CarrierPose(const Carrier& carrier, double time);
  /// In a pose that is not its motion's.
  CarrierPose(const Carrier& carrier, double time, const Posed& pose);
  Vec3d place(int particle) const;

 private:
  Posed pose_;
  const std::vector<Vec3f>*before_, *after_;
  double share_ = 0;
};

/// The most that any vertex goes between two times [m]; of a rigid one the most that a corner of its box does, which is no less.
double largest_move(const Carrier& carrier, double from, double to);

/// A box.
struct CarrierBox {
  Vec3d low, high;
};

/// Holds all vertices at a time.
CarrierBox box_at(const Carrier& carrier, double time);

}  // namespace pliant
