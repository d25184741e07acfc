#include "apps/bench/bending_energy.h"

#include <cmath>

namespace pliant::bench {

namespace {

struct Vector {
  double x, y, z;
};

Vector between(const Vec3f& from, const Vec3f& to) {
  return {double(to.x) - double(from.x), double(to.y) - double(from.y), double(to.z) - double(from.z)};
}

Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// The dihedral angle at the edge of a hinge's first two particles, 0 if it is flat [rad].
double angle(const std::vector<Vec3f>& x, const std::array<std::size_t, 4>& of) {
  const Vector e = between(x[of[0]], x[of[1]]), a = between(x[of[0]], x[of[2]]), b = between(x[of[0]], x[of[3]]);
  const Vector n1 = cross(e, a), n2 = cross(b, e);
  return std::atan2(-std::sqrt(dot(e, e)) * dot(n1, b), dot(n1, n2));
}

}  // namespace

BendingEnergy::BendingEnergy(const Scene& scene) {
  for (const Object& object : scene.objects) {
    std::vector<Hinge>& hinges = hinges_.emplace_back();
    for (const ConstraintGroup& group : object.constraints) {
      if (group.type != "dihedral_bending" || group.stiffness.kind != Stiffness::Kind::compliance) continue;
      for (std::size_t i = 0; 4 * i + 3 < group.particles.size(); ++i) {
        Hinge hinge{};
        for (std::size_t k = 0; k < 4; ++k) hinge.particle[k] = static_cast<std::size_t>(group.particles[4 * i + k]);
        const double compliance =
            static_cast<double>(i < group.compliances.size() ? group.compliances[i] : group.stiffness.value);
        hinge.rest =
            i < group.rest.size() ? static_cast<double>(group.rest[i]) : angle(object.positions, hinge.particle);
        hinge.stiffness = compliance > 0 ? 1 / compliance : 0;
        hinges.push_back(hinge);
      }
    }
  }
}

double BendingEnergy::of(const World& world) const {
  constexpr double turn = 6.283185307179586;
  double sum = 0;
  std::size_t o = 0;
  for (const ObjectId id : world.objects()) {
    const std::vector<Vec3f> x = world.object(id).positions();
    for (const Hinge& hinge : hinges_.at(o)) {
      const double c = std::remainder(angle(x, hinge.particle) - hinge.rest, turn);
      sum += 0.5 * hinge.stiffness * c * c;
    }
    ++o;
  }
  return sum;
}

}  // namespace pliant::bench
