// Tests of the rigid motion with the momentum of given corrections (solver/momentum.h).
#include "solver/momentum.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace pliant {
namespace {

struct Particle {
  double mass = 0;
  Vec3d x{}, correction{};
};

RigidSums sums_of(const std::vector<Particle>& particles) {
  RigidSums sums;
  for (const auto& [mass, x, correction] : particles) {
    sums.mass += mass;
    sums.first += x * mass;
    sums.squares += Vec3d{x.x * x.x, x.y * x.y, x.z * x.z} * mass;
    sums.products += Vec3d{x.y * x.z, x.z * x.x, x.x * x.y} * mass;
    sums.corrections.linear += correction * mass;
    sums.corrections.angular += cross(x, correction) * mass;
  }
  return sums;
}

std::vector<Particle> some_particles() {
  return {{1, {0, 0, 0}, {}}, {2, {1, 0.5, 0}, {}}, {0.5, {-1, 2, 3}, {}}, {3, {0, 0, 2}, {}}, {1.5, {2, -1, 1}, {}}};
}

void expect_near(const Vec3d& a, const Vec3d& b) { EXPECT_LT(length(a - b), 1e-12); }

TEST(RigidStep, IsTheMotionOfARigidCorrection) {
  const Vec3d translation{0.1, -0.2, 0.3}, rotation{0.01, 0.02, -0.03};
  std::vector<Particle> particles = some_particles();
  for (Particle& p : particles) p.correction = translation + cross(rotation, p.x);
  const RigidStep step = rigid_step(sums_of(particles));
  expect_near(step.translation, translation);
  expect_near(step.rotation, rotation);
}

/// What is left of any corrections has no momentum.
TEST(RigidStep, LeavesNoMomentum) {
  std::vector<Particle> particles = some_particles();
  const std::array<Vec3d, 5> corrections{Vec3d{1, 2, 3}, {-1, 0, 1}, {0.5, 0, 0}, {0, -3, 1}, {2, 2, 0}};
  for (std::size_t i = 0; i < particles.size(); ++i) particles[i].correction = corrections[i];
  const RigidStep step = rigid_step(sums_of(particles));
  for (Particle& p : particles) p.correction -= step.translation + cross(step.rotation, p.x);
  const DisplacementMomentum left = sums_of(particles).corrections;
  expect_near(left.linear, {});
  expect_near(left.angular, {});
}

/// The inertia of particles on a line, and of none, is singular.
TEST(RigidStep, IsZeroWhereItIsNotDefined) {
  const std::vector<Particle> line{{1, {0, 0, 0}, {0, 1, 0}}, {1, {1, 0, 0}, {0, 0, 1}}};
  for (const RigidStep& step : {rigid_step(sums_of(line)), rigid_step(RigidSums{})}) {
    expect_near(step.translation, {});
    expect_near(step.rotation, {});
  }
}

}  // namespace
}  // namespace pliant
