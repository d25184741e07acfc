// Contact: a unilateral constraint that keeps two sides apart.
//
//     C(x) = gap + normal . r >= 0        r = sum_i weight_i d_i - surface_motion, the relative displacement
//
// All pairs of kinds share one record, one friction rule and one restitution rule. Weights sum to 1 over the points of
// the first side and to -1 over those of the second. A static or kinematic second side has no points: its motion is
// `surface_motion`, and the weights sum to 1. A contact enters the formulas only by sums over its points, so a point
// carried by a frame needs only its own weight and generalised inverse mass.
//
// Unilateral constraints: Mueller et al. 2007, section 3.4. Friction: a Coulomb cone on the sum of a contact's normal
// corrections in the substep. Inside the static cone the contact sticks; outside it slides with the kinetic
// coefficient.
#pragma once

#include <array>
#include <cstdint>

#include "math/vector.h"
#include "pliant/vec3.h"

namespace pliant {

/// One contact of a substep: eight groups of four floats, two cache lines.
struct alignas(64) Contact {
  Vec3f normal{};   ///< unit vector from the second side to the first
  float gap = 0;    ///< value of C at the substep's start: distance minus `thickness` [m]
  Vec3f carried{};  ///< part of the relative displacement that is no motion: the points' rounding residues [m]
  /// Relative normal velocity at the beginning of the substep; negative where the sides approach [m/s]
  float approach = 0;
  Vec3f friction{};  ///< sum of this substep's tangential corrections [m]
  float push = 0;    ///< sum of this substep's normal corrections [m]
  float static_friction = 0, kinetic_friction = 0, restitution = 0;
  float thickness = 0;                  ///< distance to maintain [m]
  std::array<std::int32_t, 4> point{};  ///< indices into the arrays of the contact's owner
  std::array<float, 4> weight{};        ///< weight of each point in r; 0 in unused slots
  std::array<float, 4> share{};  ///< displacement of a point per change of r: weight_i w_i / sum_j w_j weight_j^2
  Vec3f surface_motion{};        ///< displacement of the static or kinematic side in the substep [m]
  std::int32_t collider = -1;    ///< index of the static or kinematic side; -1 if the second side has points
};
static_assert(sizeof(Contact) == 128 && alignof(Contact) == 64);

/// The parameters of a contact that its projection reads. R is one float, or one float for each lane.
template <class R>
struct ContactValues {
  Vec3<R> normal;
  R gap;
  Vec3<R> carried, surface_motion;
  R static_friction, kinetic_friction;
};

/// The corrections of a contact summed over this substep.
template <class R>
struct ContactSums {
  Vec3<R> friction;
  R push;
};

/// The change of the relative displacement by one projection: normal and tangential part.
template <class R>
struct ContactCorrection {
  Vec3<R> along, across;
};

/// Projects a contact whose points have moved by `moved` = sum weight_i d_i. If sums.push stays 0, the change is zero.
template <class R>
PLIANT_HD ContactCorrection<R> project_contact(const ContactValues<R>& c, const Vec3<R>& moved, ContactSums<R>& sums) {
  const R zero = R(0.f), depth = max(-(c.gap + dot(c.normal, moved)), zero);
  const Vec3<R> along = c.normal * depth, none{zero, zero, zero};
  sums.push = sums.push + depth;
  // Friction: the tangential correction that makes the contact stick, clamped to the Coulomb cone.
  const Vec3<R> motion = moved + along - c.carried - c.surface_motion;
  const Vec3<R> slip = motion - c.normal * dot(c.normal, motion);
  const Vec3<R> sticking = sums.friction - slip;
  const R size = length(sticking);
  const Vec3<R> sliding = sticking * (c.kinetic_friction * sums.push / max(size, R(1e-30f)));
  const auto touches = sums.push > zero;
  const Vec3<R> wanted = select(size > c.static_friction * sums.push, sliding, sticking);
  const Vec3<R> across = select(touches, wanted - sums.friction, none);
  sums.friction = select(touches, wanted, sums.friction);
  return {along, across};
}

/// The relative normal velocity after an active contact [m/s]. It is -e times the approach velocity if that exceeded
/// `slow`, the speed that gravity alone causes. Otherwise it is 0 if the sides separate, so that depenetration adds no
/// velocity. If the normal is `exact`, as for primitive shapes, a remaining approach is stopped too. Normals of nearly
/// parallel edges are tilted; stopping along them would slow sliding, so the next projection resolves the approach.
template <class R, class Mask>
PLIANT_HD R separation_after(const R& separating, const R& approach, const R& restitution, const R& slow,
                             const Mask& exact) {
  const R zero = R(0.f), stopped = select(exact, zero, min(separating, zero));
  return select(restitution > zero, select(-approach > slow, -restitution * approach, stopped), stopped);
}

/// Returns sum_i weight_i of[point_i] over the first `points` points.
template <int points = 4, class Records>
PLIANT_HD Vec3f relative(const Contact& c, const Records* of) {
  if constexpr (points == 1) {
    const auto& r = of[c.point[0]];
    return {r.x, r.y, r.z};
  } else {
    Vec3f sum{};
    for (int i = 0; i < points; ++i) {
      const auto& r = of[c.point[i]];
      sum += Vec3f{r.x, r.y, r.z} * c.weight[i];
    }
    return sum;
  }
}

/// Generalised inverse mass of r: sum w_i weight_i^2 [1/kg]. The w of `positions` are inverse masses.
template <class Records>
PLIANT_HD float inverse_mass_of(const Contact& c, const Records* positions) {
  float sum = 0;
  for (int i = 0; i < 4; ++i) sum += positions[c.point[i]].w * c.weight[i] * c.weight[i];
  return sum;
}

/// Computes the fields derived from points and weights: shares, and the relative rounding residue.
template <class Records>
PLIANT_HD void complete_contact(Contact& c, const Records* positions, const Records* remainders) {
  const float sum = inverse_mass_of(c, positions);
  for (int i = 0; i < 4; ++i) c.share[i] = sum > 0 ? positions[c.point[i]].w * c.weight[i] / sum : 0;
  c.carried = relative(c, remainders);
}

/// The overlap after `displacements`: how much the distance is below the thickness [m]; negative if it is above.
template <class Records>
PLIANT_HD float overlap_of(const Contact& c, const Records* displacements) {
  return -(c.gap + dot(c.normal, relative(c, displacements)));
}

/// Moves the points so that r changes by `change`.
template <class Records>
PLIANT_HD void move_sides(const Contact& c, const Vec3f& change, Records* of) {
  for (int i = 3; i >= 0; --i) {  // unused points repeat the first one, which is written last
    if (c.share[i] == 0) continue;
    auto& r = of[c.point[i]];
    r.x += change.x * c.share[i];
    r.y += change.y * c.share[i];
    r.z += change.z * c.share[i];
  }
}

/// Collects the parameters of one contact that may overlap by a share `yield` of its thickness.
PLIANT_HD ContactValues<float> values_of(const Contact& c, float yield = 0) {
  return {c.normal, c.gap + yield * c.thickness, c.carried, c.surface_motion, c.static_friction, c.kinetic_friction};
}

/// Projects a contact once, as far as it overlaps by more than a share `yield` of its thickness. This is the scalar
/// reference for solver/contact_lanes.cpp.
template <class Records>
PLIANT_HD void project_contact(Contact& c, Records* displacements, float yield = 0) {
  ContactSums<float> sums{c.friction, c.push};
  const auto [along, across] = project_contact(values_of(c, yield), relative(c, displacements), sums);
  if (!(sums.push > 0)) return;
  c.friction = sums.friction;
  c.push = sums.push;
  move_sides(c, along + across, displacements);
}

/// Projects a contact with a single point, which takes the whole correction.
template <class Records>
PLIANT_HD void project_point_contact(Contact& c, Records* displacements) {
  ContactSums<float> sums{c.friction, c.push};
  const Vec3f moved = relative<1>(c, displacements);
  const auto [along, across] = project_contact(values_of(c), moved, sums);
  if (!(sums.push > 0)) return;
  c.friction = sums.friction;
  c.push = sums.push;
  const Vec3f after = moved + along + across;
  auto& d = displacements[c.point[0]];
  d.x = after.x;
  d.y = after.y;
  d.z = after.z;
}

}  // namespace pliant
