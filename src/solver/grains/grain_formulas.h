// The formulas of a contact of two grains. All are odd in the direction from one to the other, so both get opposite
// corrections.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/functions.h"
#include "math/vector.h"
#include "model/cohesion.h"
#include "model/object_sets.h"
#include "solver/grains/grain_solver.h"

namespace pliant::grain_formulas {

/// Shares of overlap and of slip that a correction removes, and what it removes beyond of their change in the substep,
/// which damps. For grains with k contacts, A being the sum of the first and B of both over these, a Jacobi iteration a
/// substep is stable for A + 2 B < 4: in the densest packing, where neighbours cannot all move against one another, A =
/// 0.96 and B = 1.31.
inline constexpr float stiffness = stiffness_of_grains, damping = 0.05f, slip_stiffness = 0.08f, slip_damping = 0.04f;

/// Of two kinds of grains, those with less friction decide.
inline float common_friction(float a, float b) { return std::min(a, b); }

/// The most that cohesion pulls two grains together in a substep of `h` seconds, in all [m]. Of two kinds, those with
/// less cohesion decide, and the diameter is the harmonic mean.
inline float most_pull(const GrainTraits& a, const GrainTraits& b, float h) {
  const float cohesion = std::min(a.cohesion, b.cohesion), reach = a.radius + b.radius;
  if (!(cohesion > 0)) return 0;
  const float force = pull_of_contact(4 * (a.radius * b.radius) / reach, cohesion);
  return std::min(force * (h * h) * (a.inverse_mass + b.inverse_mass), stiffness * longest_bond * reach);
}

/// The share of a correction that a grain makes, where higher ones count as lighter (Macklin et al. 2014, section 5.2).
/// `falls`: how far it lies below its neighbour, times `gravity` [m^2/s^2]. Of two kinds, those with less mass scaling
/// decide.
inline float scaled_share(const GrainTraits& own, const GrainTraits& other, float falls, float gravity) {
  const float scaling = std::min(own.mass_scaling, other.mass_scaling);
  const float heavier = gravity > 0 ? pliant::exp(std::clamp(scaling * falls / gravity, -20.f, 20.f)) : 1.f;
  return own.inverse_mass / (own.inverse_mass + heavier * other.inverse_mass);
}

/// From the neighbour to the grain. Grains in one place part along y.
inline Vec3f normal_of(const Vec3f& between, bool is_first) {
  const float squared = dot(between, between);
  if (!(squared > 1e-24f)) return {0, is_first ? 1.f : -1.f, 0};
  return (1 / std::sqrt(squared)) * between;
}

inline Vec3f tangential(const Vec3f& v, const Vec3f& normal) { return v - dot(v, normal) * normal; }

/// v, shortened to a length.
inline Vec3f at_most(const Vec3f& v, float most) {
  const float squared = dot(v, v);
  return squared > most * most ? (most / std::sqrt(squared)) * v : v;
}

/// How far a grain and its neighbour move apart, in all. `gap` is negative without cohesion [m]; `move` is that of the
/// grain, over that of its neighbour, in the substep [m].
inline Vec3f project(float gap, const Vec3f& normal, const Vec3f& move, float friction, GrainNeighbour& n) {
  const float along = dot(move, normal);
  const float push = std::max(n.push - stiffness * gap - damping * along, 0.f - n.pull);
  const Vec3f sliding = move - along * normal, slip = tangential(n.slip, normal) + sliding;
  const Vec3f held = at_most(n.friction - slip_stiffness * slip - slip_damping * sliding, friction * (push + n.pull));
  const Vec3f by = (push - n.push) * normal + (held - n.friction);
  n.push = push;
  n.friction = held;
  return by;
}

/// Slip after a substep: no more than what friction holds. `most` is the bound of friction [m].
inline Vec3f after_motion(const Vec3f& slip, const Vec3f& move, const Vec3f& normal, float most) {
  return at_most(tangential(slip + move, normal), most / slip_stiffness);
}

}  // namespace pliant::grain_formulas
