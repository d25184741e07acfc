#include "model/soft_body_substeps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "constraints/tetrahedron_shear.h"

namespace pliant {

namespace {

/// Edges that a shear wave passes in a substep. One sweep carries a force about an edge far, so a body that is solved with longer
/// substeps yields more than its modulus says, by one to two times the square of this (docs/guide/soft_bodies.md).
constexpr double edges_per_substep = 0.25;
constexpr int fewest = 20, most = 1000;

/// What the tetrahedra of an object are like on average.
struct Averages {
  double modulus_volume = 0;  ///< shear modulus times volume [J]
  double volume = 0;          ///< [m^3]
  double edge_squared = 0;    ///< [m^2]
  double damping = 0;         ///< of the constraint on shear [J s]
  std::size_t count = 0;
};

Vec3d at(const Object& object, int particle) {
  const Vec3f& p = object.positions[static_cast<std::size_t>(particle)];
  return {p.x, p.y, p.z};
}

void add(const Object& object, const int* corners, Averages& to) {
  const Vec3d origin = at(object, corners[0]);
  const Vec3d a = at(object, corners[1]) - origin, b = at(object, corners[2]) - origin, c = at(object, corners[3]) - origin;
  to.volume += std::fabs(dot(cross(a, b), c)) / 6;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < i; ++k)
      to.edge_squared += length_squared(at(object, corners[i]) - at(object, corners[k])) / 6;
  ++to.count;
}

Averages averages_of(const Object& object) {
  Averages sum;
  for (const ConstraintGroup& group : object.constraints) {
    if (group.type != TetrahedronShear::name || group.stiffness.kind != Stiffness::Kind::compliance) continue;
    for (std::size_t t = 0; t < group.particles.size() / 4; ++t) {
      const double compliance = group.compliances.empty() ? group.stiffness.value : group.compliances[t];
      if (!(compliance > 0)) continue;  // rigid: no number of substeps suffices
      add(object, &group.particles[4 * t], sum);
      sum.modulus_volume += 1 / compliance;
      sum.damping += group.stiffness.damping;
    }
  }
  return sum;
}

}  // namespace

bool is_soft_body(const Object& object) {
  return std::any_of(object.constraints.begin(), object.constraints.end(),
                     [](const ConstraintGroup& group) { return group.type == TetrahedronShear::name; });
}

int substeps_of_soft_body(const Object& object, double frame_time) {
  const Averages all = averages_of(object);
  double mass = 0;
  for (const float one : object.masses)
    if (std::isfinite(one)) mass += static_cast<double>(one);
  if (all.count == 0 || !(mass > 0) || !(all.volume > 0)) return fewest;
  const double rate_squared = all.modulus_volume / (mass * all.edge_squared / static_cast<double>(all.count));
  const double time = all.damping / all.modulus_volume;
  // h^2 (1 + time / h) rate^2 = edges^2: damping slows a sweep down by the bracket.
  const double h = (std::sqrt(time * time + 4 * edges_per_substep * edges_per_substep / rate_squared) - time) / 2;
  return std::clamp(static_cast<int>(std::ceil(std::min(frame_time / h, 1e4))), fewest, most);
}

}  // namespace pliant
