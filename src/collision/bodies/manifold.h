// Contact of two rigid bodies: up to four points that share a normal. Part of it is kept from frame to frame.
#pragma once

#include <array>
#include <cstdint>

#include "math/vector.h"

namespace pliant {

/// Points of a contact, in a plane along its tangents [m].
struct ContactPoints {
  int count = 0;
  const std::array<float, 4>&x, &y, &gap;
};

/// Height over distance from the nearest point, below which a point touches, too.
inline constexpr float touching_slope = 0.05f;

/// True for points that touch where the nearest one does: seen from that, surfaces open by less than a twentieth.
/// Friction acts there, and not between the ends of a stick of which one is in the air.
std::array<bool, 4> touching_points(const ContactPoints& points);

/// Contact of bodies a and b. Over fifteen members: what is kept, then what is prepared once a frame (solver/bodies).
struct Manifold {
  int a = 0, b = 0;
  int count = 0;                           ///< of points, 1 to 4
  Vec3f normal{}, tangent1{}, tangent2{};  ///< unit vectors, the normal from a to b
  Vec3f arm_a{}, arm_b{};                  ///< from the centres of mass to the centre of the touching points [m]
  std::array<float, 4> x{}, y{};           ///< places of points along the tangents, from that centre [m]
  std::array<float, 4> gap{};              ///< separations at the frame's start [m]
  float friction = 0, restitution = 0;     ///< coefficients [-]
  float sliding = 1;                       ///< kinetic over static friction [-]
  float settles = 0;                       ///< of a contact that begins at rest: speed at which it slides [m/s]; else 0
  float rolling = 0, spinning = 0;         ///< greatest torque against rolling and spinning, per normal force [m]
  /// Velocity of b against a along the tangents at which friction holds: of their surfaces [m/s]
  std::array<float, 2> drift{};

  std::array<float, 4> impulse{};           ///< of the points along the normal, in a substep [N s]
  float bounced = 0;                        ///< sum of what bounces gave along the normal, in a substep [N s]
  std::array<float, 2> friction_impulse{};  ///< along the tangents, at the centre [N s]
  float twist_impulse = 0;                  ///< about the normal [N m s]
  std::array<float, 2> rolling_impulse{};   ///< about the tangents [N m s]
  std::array<float, 4> gap_now{};           ///< separations at the substep's start [m]

  std::array<float, 6> mobility{};  ///< K of normal force and moments about tangents: NN, 11, 22, 12, 2N, N1
  std::array<float, 4> mass{};      ///< that the points oppose to impulses along the normal [kg]
  std::array<float, 3> slide{};     ///< the same of the centre along the tangents, a matrix: 11, 22, 12 [kg]
  float twist_mass = 0;             ///< inertia about the normal [kg m^2]
  float twist_arm = 0;              ///< greatest torque about the normal, per normal force [m]
};

}  // namespace pliant
