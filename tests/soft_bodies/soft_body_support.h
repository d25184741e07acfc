// What the tests of soft bodies share.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "constraints/tetrahedron_shear.h"
#include "constraints/tetrahedron_volume.h"
#include "math/vector.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"
#include "support/run.h"

namespace pliant::testing_support {

inline const std::array<Vec3d, 4> tetrahedron_at_rest{Vec3d{0, 0, 0}, Vec3d{1.1, 0.1, 0}, Vec3d{0.2, 0.9, -0.1},
                                                      Vec3d{0, 0.3, 1.2}};

inline ElasticSolid solid_of(float youngs_modulus, float poisson_ratio, float density = 1000) {
  ElasticSolid solid;
  solid.density = density;
  solid.youngs_modulus = youngs_modulus;
  solid.poisson_ratio = poisson_ratio;
  return solid;
}

/// A block of 0.4 m x 0.2 m x 0.2 m of 96 tetrahedra.
inline Object block() {
  SoftBodyOptions options;
  options.material = solid_of(2e4f, 0.4f);
  return make_soft_body(box_tetrahedra({0.4f, 0.2f, 0.2f}, {4, 2, 2}), options);
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

/// Writes the rest data that a World would measure, so that the positions may change before it does.
inline void keep_rest_shape(Object& body) {
  for (ConstraintGroup& group : body.constraints)
    for (std::size_t t = 0; t < group.particles.size() / 4; ++t) {
      Vec3d x[4];
      for (std::size_t k = 0; k < 4; ++k)
        x[k] = convert<double>(body.positions[static_cast<std::size_t>(group.particles[4 * t + k])]);
      if (group.type == TetrahedronVolume::name) {
        group.rest.push_back(static_cast<float>(TetrahedronVolume::measure<double>(x).rest_volume));
        continue;
      }
      const auto d = TetrahedronShear::measure<double>(x);
      for (const double one : {d.d00, d.d01, d.d02, d.d10, d.d11, d.d12, d.d20, d.d21, d.d22})
        group.rest.push_back(static_cast<float>(one));
    }
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
