// Settings::Integrator::energy keeps the motion of elastic matter, and changes nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "motion/modes.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(EnergyIntegrator, KeepsTheAmplitudeOfSprings) {
  for (const int substeps : {4, 8, 32})
    EXPECT_GT(kept_after_ten(spring_mode(8), Integrator::energy, substeps), 0.97) << substeps;
  for (const Sweep sweep : {Sweep::tiled, Sweep::chains, Sweep::symmetric, Sweep::jacobi})
    EXPECT_GT(kept_after_ten(line_mode(8, 40, sweep), Integrator::energy, 20), 0.97) << sweep_name(sweep);
}

/// Joints that are springs have the mean of forces by default, too. Implicit Euler kept 0.69, 0.55 and 0.15.
TEST(PbdIntegrator, KeepsTheAmplitudeOfSpringJoints) {
  for (const double hertz : {1., 1.6, 5.}) {
    const double frequency = 2 * pi * hertz;
    EXPECT_GT(kept_after_ten(spring_mode(frequency), Integrator::pbd), 0.95) << hertz;
    EXPECT_GT(kept_after_ten(spring_mode(frequency, 0, 2), Integrator::pbd), 0.95) << hertz << ", in loops";
    EXPECT_GT(kept_after_ten(hinge_mode(frequency), Integrator::pbd), 0.95) << hertz;
  }
}

TEST(EnergyIntegrator, KeepsTheAmplitudeOfSolids) {
  EXPECT_GT(kept_after_ten(bar_mode(1e5, 0.3, 0, false), Integrator::energy), 0.95);
  EXPECT_LT(kept_after_ten(bar_mode(1e5, 0.3, 0, false), Integrator::pbd), 0.75);
  EXPECT_GT(kept_after_ten(bar_mode(1e6, 0.45, 0, false), Integrator::energy, 40), 0.95);
  EXPECT_GT(kept_after_ten(bar_mode(1e6, 0.3, 0, true), Integrator::energy), 0.95);
}

TEST(EnergyIntegrator, KeepsTheAmplitudeOfRodsAndCloth) {
  EXPECT_GT(kept_after_ten(rod_mode(1e9, 1), Integrator::energy), 0.95);
  EXPECT_LT(kept_after_ten(rod_mode(1e9, 1), Integrator::pbd), 0.5);
  EXPECT_GT(kept_after_ten(rod_mode(1e9, 8), Integrator::energy), 0.95);
  for (const Sweep sweep : {Sweep::tiled, Sweep::chains}) {
    EXPECT_GT(kept_after_ten(cloth_mode(50, sweep), Integrator::energy, 20), 0.95) << sweep_name(sweep);
    EXPECT_LT(kept_after_ten(cloth_mode(50, sweep), Integrator::pbd, 20), 0.65) << sweep_name(sweep);
  }
}

/// The damping of matter acts beside it as it says: exp(-omega^2 tau t / 2).
TEST(EnergyIntegrator, LeavesDampingAsItIs) {
  Settings settings;
  settings.integrator = Integrator::energy;
  settings.threads = 1;
  settings.substeps = 20;
  const Mode mode = spring_mode(8, 1);
  const ModeTrace trace(mode, settings, 4);
  const double omega = trace.frequency(8);
  const std::size_t later = 120;
  EXPECT_NEAR(std::log(trace.amplitude(0, omega) / trace.amplitude(later, omega)) / 2 / 0.5, 1, 0.02);
}

/// What hangs at rest is where its forces balance, and stays there.
TEST(EnergyIntegrator, LeavesTheRestShape) {
  Mode mode = spring_mode(8);
  mode.scene.gravity = {0.981f, 0, 0};
  mode.scene.objects[0].damping = 4;
  mode.scene.settings.integrator = Integrator::energy;
  World world(mode.scene);
  testing_support::run(world, 300);
  EXPECT_NEAR(double(world.object(0).positions()[0].x) - 1, 0.981 / 64, 1e-4);
}

/// The largest kinetic energy in 200 frames of four substeps each, over that of the start.
double most_energy(Mode mode, Integrator integrator = Integrator::energy) {
  std::vector<Vec3f>& velocities = mode.scene.objects[0].velocities;
  for (std::size_t i = 0; i < velocities.size(); ++i)
    velocities[i] += Vec3f{0, i % 3 == 0 ? 0.02f : -0.01f, i % 2 == 0 ? 0.01f : -0.01f};
  mode.scene.settings.integrator = integrator;
  mode.scene.settings.substeps = 4;
  World world(mode.scene);
  const double start = world.measure().kinetic_energy();
  double most = 0;
  for (int i = 0; i < 200; ++i) {
    EXPECT_TRUE(world.step(1.f / 60).ok());
    most = std::max(most, world.measure().kinetic_energy());
  }
  return most / start;
}

/// Stiff matter at few substeps: its errors may not grow.
TEST(EnergyIntegrator, IsStableWhereTheSubstepsAreTooFew) {
  for (const Sweep sweep : {Sweep::tiled, Sweep::chains, Sweep::symmetric, Sweep::jacobi})
    for (const double frequency : {30., 300., 3000.})
      EXPECT_LT(most_energy(line_mode(frequency, 30, sweep)), 1.2) << frequency << " " << sweep_name(sweep);
  for (const double modulus : {1e6, 1e7, 1e8, 1e10}) {
    EXPECT_LT(most_energy(bar_mode(modulus, 0.45, 0, true)), 1.2) << modulus;
    EXPECT_LT(most_energy(rod_mode(100 * modulus, 1)), 1.2) << modulus;
  }
  for (const Sweep sweep : {Sweep::tiled, Sweep::chains})
    for (const double stiffness : {100., 1e4, 1e6})
      EXPECT_LT(most_energy(cloth_mode(stiffness, sweep)), 1.2) << stiffness << " " << sweep_name(sweep);
}

TEST(PbdIntegrator, IsStableWhereSpringJointsAreTooStiffForTheSubsteps) {
  for (const double frequency : {30., 300., 3000., 1e5})
    EXPECT_LT(most_energy(bodies_on_springs(frequency, 8), Integrator::pbd), 1.2) << frequency;
}

/// A soft block and rods that fly and turn keep their momenta.
TEST(EnergyIntegrator, KeepsMomenta) {
  SoftBodyOptions options;
  options.material.youngs_modulus = 2e4f;
  Object block = make_soft_body(box_tetrahedra({0.4f, 0.2f, 0.2f}, {4, 2, 2}), options);
  for (const Vec3f& x : block.positions) block.velocities.push_back(Vec3f{1, 2, 0} + cross(Vec3f{0, 1, 3}, x));
  Scene scene;
  scene.gravity = {};
  scene.settings.integrator = Integrator::energy;
  scene.add(block);
  World world(scene);
  const auto momenta = [&] {
    Vec3d linear{}, angular{};
    for (std::size_t i = 0; i < block.positions.size(); ++i) {
      const Vec3d p = convert<double>(world.object(0).velocities()[i]) * double(block.masses[i]);
      linear = linear + p;
      angular = angular + cross(convert<double>(world.object(0).positions()[i]), p);
    }
    return std::vector<Vec3d>{linear, angular};
  };
  const auto before = momenta();
  testing_support::run(world, 60);
  const auto after = momenta();
  EXPECT_LT(length(after[0] - before[0]), 1e-4 * length(before[0]));
  EXPECT_LT(length(after[1] - before[1]), 0.01 * length(before[1]));
}

std::vector<Vec3f> places_after(const Scene& scene, const std::string& isa, int threads) {
  Settings settings = scene.settings;
  settings.isa = isa;
  settings.threads = threads;
  settings.integrator = Integrator::energy;
  World world(scene, settings);
  testing_support::run(world, 5);
  std::vector<Vec3f> places;
  for (const auto& x : world.object(0).positions()) places.push_back(x);
  return places;
}

TEST(EnergyIntegrator, GivesTheSameBitsInLanesAndOnThreads) {
  std::vector<Mode> modes{
      bar_mode(1e5, 0.3, 0, true),     bar_mode(1e5, 0.45, 0.004, false), rod_mode(1e8, 8),
      rod_mode(1e8, 7, 0.003),         cloth_mode(50, Sweep::tiled),      cloth_mode(50, Sweep::chains),
      line_mode(20, 40, Sweep::chains)};
  for (Mode& mode : modes) {
    mode.scene.gravity = {0, -9.81f, 0};
    const auto own = places_after(mode.scene, "", 1);
    EXPECT_TRUE(own == places_after(mode.scene, "sequential", 1)) << mode.scene.objects[0].name;
    EXPECT_TRUE(own == places_after(mode.scene, "", 3)) << mode.scene.objects[0].name;
  }
}

}  // namespace
}  // namespace pliant
