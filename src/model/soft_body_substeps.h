// The substeps of elastic tetrahedra.
#pragma once

#include "pliant/scene.h"

namespace pliant {

/// True if constraints on the shear of tetrahedra make the object an elastic solid.
bool is_soft_body(const Object& object);

/// The substeps with which one sweep holds a soft body about as stiffly as its modulus says: in each, a shear wave
/// passes a quarter of an edge of three in four of its tetrahedra, or less where its constraints are damped by more than
/// a substep is long. At least 20.
double needed_substeps_of_soft_body(const Object& object, double frame_time);

/// True if tetrahedra around edges keep their volume together (model/join_volumes.h), as from a Poisson's ratio of 0.4
/// on.
bool keeps_volumes_jointly(const Object& object);

/// The most substeps by default.
inline constexpr int most_soft_substeps = 1000;

/// The same, rounded up, at most most_soft_substeps.
int substeps_of_soft_body(const Object& object, double frame_time);

/// What is said of a soft body's numbers before it runs.
struct SoftBodyNumbers {
  /// Of its lowest layer: density gravity height / Young's modulus, taken as 2.6 shear moduli [-]
  double strain_by_weight = 0;
  double damping_time = 0;  ///< of the constraint on shear [s]
};
SoftBodyNumbers numbers_of_soft_body(const Object& object, const Vec3f& gravity);

}  // namespace pliant
