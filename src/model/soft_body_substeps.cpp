#include "model/soft_body_substeps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "constraints/fibre.h"
#include "constraints/gives_shape.h"
#include "constraints/registry.h"

namespace pliant {

namespace {

/// Edges that a shear wave passes in a substep. One sweep carries a force about an edge far, so a body that is solved
/// with longer substeps yields more than its modulus says: with twice as long ones by 15 % (docs/internals/solids.md).
constexpr double edges_per_substep = 0.25;
constexpr int fewest_soft_substeps = 20;
/// What a tetrahedron of a cube of side a, cut into six, has: sum of squared gradients of its four barycentric
/// coordinates, times a^2; and the mean of its squared edges over a^2.
constexpr double gradients_of_cube = 6, edges_of_cube = 5. / 3;
/// The share of the tetrahedra for which substeps are short enough. Flat ones that are left are stiff in themselves:
/// what is left to sweeps is that they move with their neighbours.
constexpr double share_of_tetrahedra = 0.75;

/// A tetrahedron: its volume, its shear modulus, and 1 over the square of a length that a flat or a short one has
/// small.
struct Measured {
  const int* corners;
  double volume, modulus, per_length_squared;
};

Vec3d position_of(const Object& object, int particle) {
  const Vec3f& p = object.positions[static_cast<std::size_t>(particle)];
  return {p.x, p.y, p.z};
}

Measured measured(const Object& object, const int* corners, double compliance) {
  const Vec3d origin = position_of(object, corners[0]);
  const Vec3d a = position_of(object, corners[1]) - origin, b = position_of(object, corners[2]) - origin,
              c = position_of(object, corners[3]) - origin;
  const Vec3d bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double six = std::fabs(dot(ab, c));
  const Vec3d rest = bc + ca + ab;
  const double squares = length_squared(bc) + length_squared(ca) + length_squared(ab) + length_squared(rest);
  return {corners, six / 6, 6 / (compliance * six), squares / (six * six) / gradients_of_cube / edges_of_cube};
}

/// What the tetrahedra of an object are like.
struct MeasuredSolid {
  std::vector<Measured> tetrahedra;
  double volume = 0, mass = 0;        ///< of all
  double stiffness = 0, damping = 0;  ///< sums over the constraints on shear
  double of_volume = 0;               ///< sum of stiffness over those on volume
};

/// Adds the modulus of fibres to the shear modulus of their tetrahedra: a third, as of an incompressible solid's
/// Young's modulus.
void stiffen_by_fibres(const Object& object, MeasuredSolid& solid) {
  std::map<std::array<int, 4>, Measured*> by_corners;
  const auto corners = [](const int* first) { return std::array<int, 4>{first[0], first[1], first[2], first[3]}; };
  for (const ConstraintGroup& group : object.constraints) {
    if (group.type != Fibre::name || group.stiffness.kind != Stiffness::Kind::compliance) continue;
    if (by_corners.empty())
      for (Measured& one : solid.tetrahedra) by_corners[corners(one.corners)] = &one;
    for (std::size_t t = 0; t < group.particles.size() / 4; ++t) {
      const double compliance = group.compliances.empty() ? group.stiffness.value : group.compliances[t];
      const auto found = by_corners.find(corners(&group.particles[4 * t]));
      if (found == by_corners.end() || !(compliance > 0)) continue;
      found->second->modulus += 1 / (compliance * found->second->volume) / 3;
    }
  }
}

bool is_of_volume(const std::string& name) {
  const int type = find_constraint_type(name);
  return type >= 0 && belongs_to_solid(type) && !gives_shape(type);
}

/// The sum of 1 / compliance; 0 of PBD stiffness.
double stiffness_of(const ConstraintGroup& group) {
  if (group.stiffness.kind != Stiffness::Kind::compliance) return 0;
  double sum = 0;
  for (std::size_t t = 0; t < group.particles.size() / 4; ++t) {
    const float compliance = group.compliances.empty() ? group.stiffness.value : group.compliances[t];
    if (compliance > 0) sum += 1 / static_cast<double>(compliance);
  }
  return sum;
}

MeasuredSolid solid_of(const Object& object) {
  MeasuredSolid solid;
  std::vector<bool> is_corner(object.positions.size(), false);
  for (const ConstraintGroup& group : object.constraints) {
    if (is_of_volume(group.type)) solid.of_volume += stiffness_of(group);
    if (!gives_shape(group.type) || group.stiffness.kind != Stiffness::Kind::compliance) continue;
    for (std::size_t t = 0; t < group.particles.size() / 4; ++t) {
      const double compliance = group.compliances.empty() ? group.stiffness.value : group.compliances[t];
      const Measured one = measured(object, &group.particles[4 * t], compliance);
      if (!(compliance > 0) || !(one.volume > 0)) continue;  // rigid: no number of substeps suffices
      solid.tetrahedra.push_back(one);
      solid.volume += one.volume;
      solid.stiffness += 1 / compliance;
      solid.damping += group.stiffness.damping;
      for (std::size_t k = 0; k < 4; ++k) is_corner[static_cast<std::size_t>(group.particles[4 * t + k])] = true;
    }
  }
  stiffen_by_fibres(object, solid);
  for (std::size_t i = 0; i < is_corner.size(); ++i)  // not those of bodies that it is tied to
    if (is_corner[i] && std::isfinite(object.masses[i])) solid.mass += static_cast<double>(object.masses[i]);
  return solid;
}

/// The square of the rate at which a shear wave passes edges, of three in four tetrahedra [1/s^2].
double rate_squared(const MeasuredSolid& solid) {
  std::vector<double> rates;
  rates.reserve(solid.tetrahedra.size());
  for (const Measured& one : solid.tetrahedra)
    rates.push_back(one.modulus * one.per_length_squared * solid.volume / solid.mass);
  const auto place = static_cast<std::size_t>(share_of_tetrahedra * static_cast<double>(rates.size() - 1));
  std::nth_element(rates.begin(), rates.begin() + static_cast<std::ptrdiff_t>(place), rates.end());
  return rates[place];
}

/// How many times more substeps a solid needs that hardly changes its volume, up to `most`. `ratio`: lambda over mu; 9
/// at a Poisson's ratio of 0.45, 15.7 at 0.47. Up to `free_ratio` it needs no more.
double more_for_volume(double ratio, double free_ratio, double most) {
  return ratio > free_ratio ? most - (most - 1) * free_ratio / ratio : 1;
}

}  // namespace

bool is_soft_body(const Object& object) {
  return std::any_of(object.constraints.begin(), object.constraints.end(),
                     [](const ConstraintGroup& group) { return gives_shape(group.type); });
}

bool keeps_volumes_jointly(const Object& object) {
  constexpr double least_ratio = 3.99;  // as least_ratio of join_volumes.cpp, up to rounding
  const MeasuredSolid solid = solid_of(object);
  return solid.of_volume >= least_ratio * solid.stiffness;
}

double needed_substeps_of_soft_body(const Object& object, double frame_time) {
  const MeasuredSolid solid = solid_of(object);
  if (solid.tetrahedra.empty() || !(solid.mass > 0)) return fewest_soft_substeps;
  const double time = solid.damping / solid.stiffness;
  // h^2 max(1, time / h) rate^2 = edges^2: elastic and viscous stress together slow a sweep down by the maximum, since
  // a substep has as much damping of its own as a time of h (solver/damper.h).
  const double squared = edges_per_substep * edges_per_substep / rate_squared(solid);
  const double ratio = solid.of_volume / solid.stiffness, more = more_for_volume(ratio, 9, 1.4);
  const double undamped = std::sqrt(squared) / more;
  const double h = std::min(undamped, squared / (std::max(time, 1e-30) * more * more_for_volume(ratio, 15.7, 1.5)));
  return std::max(frame_time / h, static_cast<double>(fewest_soft_substeps));
}

SoftBodyNumbers numbers_of_soft_body(const Object& object, const Vec3f& gravity) {
  const MeasuredSolid solid = solid_of(object);
  if (solid.tetrahedra.empty()) return {};
  double low = 1e300, high = -1e300;  // along gravity, times its size
  for (const Vec3f& p : object.positions) {
    const double along = static_cast<double>(dot(p, gravity));
    low = std::min(low, along);
    high = std::max(high, along);
  }
  const double modulus = 2.6 * solid.stiffness / solid.volume;
  return {solid.mass / solid.volume * (high - low) / modulus, solid.damping / solid.stiffness};
}

int substeps_of_soft_body(const Object& object, double frame_time) {
  return static_cast<int>(
      std::ceil(std::min(needed_substeps_of_soft_body(object, frame_time), static_cast<double>(most_soft_substeps))));
}

}  // namespace pliant
