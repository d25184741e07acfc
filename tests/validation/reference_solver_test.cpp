// Compares the reference solver with answers that need no oracle.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pliant/reference.h"

namespace pliant::reference {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Two free particles of 1 and 3 kg, 0.5 m too far apart.
Solver stretched(const Hardness& hardness) {
  Solver solver;
  solver.add({0, 0, 0}, 1);
  solver.add({1.5, 0, 0}, 3);
  solver.add("distance", {0, 1}, {1}, hardness);
  return solver;
}

TEST(ReferenceSolver, OneRigidProjectionClosesTheGapByInverseMass) {
  Solver solver = stretched({});
  solver.step(0.1);
  EXPECT_NEAR(solver.particles[0].position.x, 0.375, 1e-15);
  EXPECT_NEAR(solver.particles[1].position.x, 1.375, 1e-15);
  EXPECT_NEAR(solver.particles[0].velocity.x, 3.75, 1e-13);
}

TEST(ReferenceSolver, PbdStiffnessRemovesItsShareHoweverManyIterations) {
  for (int iterations : {1, 3, 10}) {
    Solver solver = stretched({0, 0, 0.4});
    solver.iterations = iterations;
    solver.step(0.1);
    EXPECT_NEAR(solver.value(0), 0.5 * 0.6, 1e-14) << iterations;
  }
}

// If alpha / h^2 equals the generalised inverse mass, half of the error remains, which the spring's force balances.
TEST(ReferenceSolver, CompliantProjectionIsTheSameHoweverManyIterations) {
  const double h = 0.1, weight = 1 + 1.0 / 3;
  for (int iterations : {1, 3, 10}) {
    Solver solver = stretched({weight * h * h, 0, -1});
    solver.iterations = iterations;
    solver.step(h);
    EXPECT_NEAR(solver.value(0), 0.25, 1e-14) << iterations;
    EXPECT_NEAR(solver.multiplier(0), -0.25 / weight, 1e-14) << iterations;
  }
}

// A spring balances its load at the right length only if its multiplier restarts at zero in each substep.
TEST(ReferenceSolver, AHangingMassStaysAtItsStaticStretch) {
  Solver solver;
  solver.gravity = {0, -10, 0};
  solver.substeps = 3;
  solver.iterations = 2;
  solver.add({0, 0, 0}, infinity);
  solver.add({0, -1.1, 0}, 1);
  solver.add("distance", {0, 1}, {1}, {0.01, 0, -1});
  for (int i = 0; i < 20; ++i) solver.step(0.02);
  EXPECT_NEAR(solver.value(0), 0.1, 1e-13);
}

TEST(ReferenceSolver, PinsStayAndFreeParticlesFall) {
  Solver solver;
  solver.gravity = {0, -10, 0};
  solver.substeps = 4;
  solver.add({1, 2, 3}, infinity);
  solver.add({0, 0, 0}, 2);
  solver.step(0.4);
  EXPECT_EQ(solver.particles[0].position.y, 2);
  EXPECT_NEAR(solver.particles[1].position.y, -10 * 0.01 * 4 * 5 / 2, 1e-14);
  EXPECT_NEAR(solver.particles[1].velocity.y, -4, 1e-14);
  EXPECT_NEAR(solver.kinetic_energy(), 16, 1e-12);
}

TEST(ReferenceSolver, VelocityDampingLosesItsShareASecond) {
  Solver solver;
  solver.damping = 2;
  solver.substeps = 10;
  solver.add({0, 0, 0}, 1, {1, 0, 0});
  solver.step(1);
  EXPECT_NEAR(solver.particles[0].velocity.x, std::exp(-2), 1e-14);
}

}  // namespace
}  // namespace pliant::reference
