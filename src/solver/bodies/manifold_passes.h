// Contact of two rigid bodies: up to four points that share a normal, solved together through the motion at their
// centre.
//
// One multiplier per point is kept over substeps and frames. A soft pass moves the bodies apart, a second pass takes
// back the velocity that this made. Arms and normal stay those of the manifold's birth while the pair hardly moves;
// gaps are renewed. Impacts with restitution come before both passes. Soft constraints: Catto 2011; substeps: Macklin
// et al. 2019.
#pragma once

#include <array>

#include "collision/bodies/manifold.h"
#include "math/vector.h"

namespace pliant {

/// The motion of a body in a frame, as contact sees it. A fixed body has zero inverse mass and inertia. It consists of
/// records of four floats, which kernels load for sixteen bodies at a time.
struct alignas(64) BodyMotion {
  Vec3f velocity{};        ///< of the centre of mass [m/s]
  float inverse_mass = 0;  ///< [1/kg]
  Vec3f spin{};            ///< angular velocity in world axes [rad/s]
  float unused_by_spin = 0;
  std::array<float, 6> inverse_inertia{};  ///< in world axes: xx, yy, zz, yz, zx, xy [1/(kg m^2)]
  std::array<float, 2> unused_by_inertia{};
  Vec3f displacement{};  ///< since the frame's start [m]
  float unused_by_displacement = 0;
  Vec3f rotation{};  ///< since the frame's start, as a vector in world axes [rad]
  float unused_by_rotation = 0;
  Vec3f kept_velocity{};  ///< velocity and spin before a pass
  float unused_by_kept_velocity = 0;
  Vec3f kept_spin{};
  float unused_by_kept_spin = 0;
};
static_assert(sizeof(BodyMotion) == 128, "eight Records (records_a_motion)");

/// How stiff contacts are, as shares for each substep.
struct ContactSoftness {
  float beta = 0.04f;     ///< share of a penetration that is corrected
  float epsilon = 0.04f;  ///< share of the multiplier that leaks; beta / epsilon is a stiffness
  float fastest = 3;      ///< largest speed of separation [m/s]
};

/// The numbers of a pass that follow from the substep h [s].
struct PassNumbers {
  float inverse_h = 0;  ///< [1/s]
  float beta_h = 0;     ///< beta / h [1/s]
  float kept = 1;       ///< 1 - epsilon
  float epsilon = 0;
  float fastest = 0;  ///< [m/s]
};
inline PassNumbers pass_numbers(float h, const ContactSoftness& softness) {
  return {1 / h, softness.beta / h, 1 - softness.epsilon, softness.epsilon, softness.fastest};
}

/// Computes what follows from arms, normal and inertia. Call it once a frame.
void prepare(Manifold& manifold, const BodyMotion& a, const BodyMotion& b);

/// Applies the kept impulses, at the start of a substep.
void warm_start(const Manifold& manifold, BodyMotion& a, BodyMotion& b);

/// Where points would pass through in this substep, faster than twice `fall`, which is what gravity adds to velocities
/// in the substep [m/s], gives them the velocity that restitution demands. Returns true if there were any, and adds
/// their impulses to Manifold::bounced. Called for all manifolds in turn until none is left, before the passes, so that
/// a row of balls passes an impact on.
bool bounce(Manifold& manifold, BodyMotion& a, BodyMotion& b, float h, const Vec3f& fall);

/// Corrects velocities so that gaps become shorter by their share: friction first, then the points one after another.
void position_pass(Manifold& manifold, BodyMotion& a, BodyMotion& b, float h, const ContactSoftness& softness);

/// Takes back the velocity of separation that the position pass made, after displacements have followed.
void velocity_pass(Manifold& manifold, BodyMotion& a, BodyMotion& b, float h);

}  // namespace pliant
