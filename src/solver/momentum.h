// Keeps inflated objects from turning and drifting by themselves.
//
// A substep conserves angular momentum if sum_i m_i x_i x c_i = 0, where x are the positions at its start and c the
// corrections, because velocities become the displacement / h. Each projection has no torque about the positions x + d
// at which its gradient is taken, so it leaves sum_i m_i d_i x c_i. Such errors have second order and cancel out,
// unless corrections are large in every substep: the volume pushes out what the lengths pull in, without end, or pulls
// in what they push out. Then a balloon at rest starts to turn, by the same torque in each substep.
//
// So what the constraints of such an object change is reduced by its rigid motion: c_i -= p + theta x (x_i - x_c), with
// M p = sum_i m_i c_i and I theta = sum_i m_i (x_i - x_c) x c_i. Contacts, friction and forces are not affected. What
// chains give to rigid bodies that their particles carry (bodies/point_loads.h) is left out of these sums, so Newton's
// third law holds. Sums are in double precision, by tiles and then over tiles in order, so any number of threads gives
// the same bits.
#pragma once

#include <vector>

#include "math/vector.h"

namespace pliant {

struct Substep;

/// Linear and angular momentum of displacements about an object's first particle, times the duration of a substep.
struct DisplacementMomentum {
  Vec3d linear{};   ///< sum of m d [kg m]
  Vec3d angular{};  ///< sum of m x cross d [kg m^2]
};

/// Masses of particles about an object's first particle, and the momentum of their corrections.
struct RigidSums {
  double mass = 0;                     ///< [kg]
  Vec3d first{};                       ///< sum of m x [kg m]
  Vec3d squares{}, products{};         ///< sums of m x x, m y y, m z z and of m y z, m z x, m x y [kg m^2]
  DisplacementMomentum corrections{};  ///< of corrections
};

/// A small rigid motion about an object's first particle.
struct RigidStep {
  Vec3d translation{};  ///< [m]
  Vec3d rotation{};     ///< rotation vector [rad]
};

/// The rigid motion with the momentum of the corrections. Zero where it is not finite.
RigidStep rigid_step(const RigidSums& sums);

/// What an object's own constraints have changed since.
enum class Since { prediction, note };

/// Starts conserve_momentum() of inflated objects, of all that are swept or of those with 1 in `only`. With Since::note
/// it notes the momentum of their displacements.
void note_momentum(Substep& s, Since since, const std::vector<char>* only = nullptr);

/// Keeps an impulse on a body, times the duration of a substep [kg m], that an object's own constraints have given it:
/// the object keeps the opposite one. `place` is where it acts, relative to the object's first particle.
void note_impulse_on_body(Substep& s, int object, const Vec3f& place, const Vec3f& impulse);

/// Removes the rigid motion from what has changed since prediction, or since note_momentum(), which must have been
/// called with the same arguments. Nothing but the objects' own constraints may have moved them in between; impulses
/// that these have given to bodies must have been noted.
void conserve_momentum(Substep& s, Since since, const std::vector<char>* only = nullptr);

}  // namespace pliant
