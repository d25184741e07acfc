// What the tests of soft bodies share.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "math/vector.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"

namespace pliant::testing_support {

inline ElasticSolid solid_of(float youngs_modulus, float poisson_ratio, float density = 1000) {
  ElasticSolid solid;
  solid.density = density;
  solid.youngs_modulus = youngs_modulus;
  solid.poisson_ratio = poisson_ratio;
  return solid;
}

inline double six_volumes(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(cross(b - a, c - a), d - a);
}

/// Six times the volume of each tetrahedron at the given positions.
inline std::vector<double> six_volumes(const std::vector<Vec3f>& positions,
                                       const std::vector<std::array<int, 4>>& tetrahedra) {
  std::vector<double> out;
  const auto at = [&](int i) { return convert<double>(positions[static_cast<std::size_t>(i)]); };
  for (const auto& [a, b, c, d] : tetrahedra) out.push_back(six_volumes(at(a), at(b), at(c), at(d)));
  return out;
}

/// A scene with one soft body, one thread and this many substeps; 0: those by default.
inline Scene scene_of(Object body, int substeps) {
  Scene scene;
  scene.settings.substeps = substeps;
  scene.settings.threads = 1;
  scene.add(std::move(body));
  return scene;
}

inline std::vector<Vec3f> positions_of(const World& world) { return world.object(ObjectId(0)).positions(); }

inline void run(World& world, int frames) {
  for (int i = 0; i < frames; ++i) {
    const Report report = world.step(1.f / 60);
    ASSERT_TRUE(report.ok()) << report.explain();
  }
}

/// Momentum, and angular momentum about the origin, of masses of a body.
struct Momentum {
  Vec3d linear{}, angular{};
};

inline Momentum momentum_of(const World& world, const std::vector<float>& masses) {
  Momentum sum;
  const std::vector<Vec3f> positions = positions_of(world), velocities = world.object(ObjectId(0)).velocities();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const Vec3d p = convert<double>(velocities[i]) * static_cast<double>(masses[i]);
    sum.linear += p;
    sum.angular += cross(convert<double>(positions[i]), p);
  }
  return sum;
}

}  // namespace pliant::testing_support
