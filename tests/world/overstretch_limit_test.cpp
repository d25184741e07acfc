// The limit of overstretch, and chains with tethers.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "world/substep_law_support.h"

namespace pliant {
namespace {

using namespace testing_support;

double largest_overstretch(const Scene& scene, int frames) {
  World world(scene);
  double largest = 0;
  for (int frame = 0; frame < frames; ++frame) {
    world.step(dt);
    largest = std::max(largest, world.measure().overstretch().largest);
  }
  return largest;
}

/// A cube of 0.2 m that stands on a corner, as a mesh.
MeshCollider tilted_cube() {
  MeshCollider collider;
  collider.mesh = box_mesh({0.2f, 0.2f, 0.2f});
  for (Vec3f& p : collider.mesh.positions) p = rotate(rotation({1, 0, -1}, 54.7356f), p);
  return collider;
}

TEST(OverstretchLimit, HoldsWhereACornerBearsTheSheet) {
  Scene scene;
  scene.gravity = {0, -20, 0};
  ClothOptions options;
  options.material = fabric("cotton");
  Object sheet = sheet_at("sheet", {0.003f, 0.2f, 0.002f}, 60, 0.6f, options);
  sheet.thickness = 0.002f;
  sheet.self_collision = true;
  scene.add(sheet);
  scene.add(tilted_cube());
  EXPECT_LT(largest_overstretch(scene, 8), 0.09);  // 0.15 with two rounds of the limit
}

TEST(OverstretchLimit, HoldsAtAnImpactWhatChainsDoNot) {
  Scene scene = impact();
  scene.settings.sweep = Sweep::chains;
  scene.settings.substeps = 10;
  const double limited = largest_overstretch(scene, 50);
  scene.settings.sweep_options.most_overstretch = 0;
  EXPECT_GT(largest_overstretch(scene, 50), 1.5 * limited);
  EXPECT_LT(limited, 0.2);
}

/// In 20 substeps a corner is 14 % too long for the force that acts there.
TEST(OverstretchLimit, HoldsForRubberThatHangsByTwoCorners) {
  Scene scene;
  ClothOptions options;
  options.material = fabric("rubber sheet");
  Object sheet = sheet_at("sheet", {}, 40, 1, options);
  sheet.pins = {{0, {}}, {39, {}}};
  scene.add(sheet);
  EXPECT_LT(largest_overstretch(scene, 100), 0.06);
}

/// Rubber stretches as its force explains: the limit must not hold it.
TEST(OverstretchLimit, LetsRubberStretch) {
  const auto longest = [](float limit) {
    Scene scene;
    Object rope;
    for (int i = 0; i < 40; ++i) rope.positions.push_back({0, -0.05f * static_cast<float>(i), 0});
    rope.masses.assign(40, 0.01f);
    ConstraintGroup group{"distance", {}, {}, Stiffness::compliance(0.01f), {}};
    for (int i = 0; i + 1 < 40; ++i) group.particles.insert(group.particles.end(), {i, i + 1});
    rope.constraints.push_back(group);
    rope.pins = {{0, {}}};
    rope.damping = 2;
    scene.add(rope);
    scene.settings = settings_of(20);
    scene.settings.sweep = Sweep::chains;
    scene.settings.sweep_options.most_overstretch = limit;
    World world(scene);
    for (int frame = 0; frame < 300; ++frame) world.step(dt);
    return world.measure().stretch().largest;
  };
  const double free = longest(0);
  EXPECT_NEAR(free, 1 + 0.01 * 0.01 * 9.81 * 39 / 0.05, 0.02);  // 39 links hang from the first: 77 % longer
  EXPECT_NEAR(longest(0.05f), free, 1e-3);
}

/// A damped spring that contracts is longer than its elastic force explains: its damping force explains the rest.
TEST(OverstretchLimit, LeavesDampedDistancesAlone) {
  const auto lowest = [](float limit) {
    Scene scene;
    Object rope;
    for (int i = 0; i < 40; ++i) rope.positions.push_back({0.05f * static_cast<float>(i), 0, 0});
    rope.masses.assign(40, 0.01f);
    ConstraintGroup group{"distance", {}, {}, Stiffness::compliance(0.01f, 0.2f), {}};
    for (int i = 0; i + 1 < 40; ++i) group.particles.insert(group.particles.end(), {i, i + 1});
    rope.constraints.push_back(group);
    rope.pins = {{0, {}}};
    scene.add(rope);
    scene.settings = settings_of(20);
    scene.settings.sweep = Sweep::chains;
    scene.settings.sweep_options.most_overstretch = limit;
    scene.settings.record_multipliers = true;
    World world(scene);
    for (int frame = 0; frame < 120; ++frame) EXPECT_TRUE(world.step(dt).ok());
    return world.object({0}).positions().back().y;
  };
  EXPECT_EQ(lowest(0.05f), lowest(0));
}

/// Pulled apart as a whole, cloth cannot be shortened edge by edge: that must not be tried for ever.
TEST(OverstretchLimit, GivesUpWhereEverythingIsTooLong) {
  Scene scene;
  Object cloth = falling_sheet(40);
  cloth.self_collision = false;
  for (int i = 0; i < 40; ++i) {
    cloth.pins.push_back({i, {}});
    cloth.pins.push_back({1560 + i, straight({0, 0, 0.4f}, 1)});
  }
  scene.add(cloth);
  World world(scene);
  run(world, 60);
  EXPECT_TRUE(is_finite(world.state()));
  EXPECT_GT(world.measure().stretch().mean, 1.1);
}

// ---------------------------------------------------------------- tethered chains

TEST(TetheredChains, AreChosenForRegularClothThatHangs) {
  EXPECT_EQ(chosen_sweep(hung(), 0), Sweep::tethered_chains);
  EXPECT_EQ(chosen_sweep(hung(0.3f), 0), Sweep::chains);  // the pins move apart
}

TEST(TetheredChains, HangWithoutGainingEnergyWithFewSubsteps) {
  World world(hung());
  double least = 1e30, gain = 0, substeps = 0;
  Overstretch worst;
  for (int frame = 0; frame < 200; ++frame) {
    substeps += world.step(dt).substeps;
    const double energy = world.measure().kinetic_energy() + world.measure().potential_energy();
    least = std::min(least, energy);
    gain = std::max(gain, energy - least);
    worst.p99 = std::max(worst.p99, world.measure().overstretch().p99);
  }
  EXPECT_LT(gain / 0.15, 0.01);  // J/kg
  EXPECT_LE(worst.p99, 0.02);
  EXPECT_LT(substeps / 200, 14);
}

/// Pins that the user moves apart: tethers to both would pull a particle to and fro, so they are left out.
TEST(TetheredChains, LeaveTethersOutWhilePinsMoveApart) {
  World world(hung());
  double largest = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const Vec3f to = world.object({0}).positions()[19] + Vec3f{-0.005f, 0, 0};
    world.object({0}).set_targets(std::vector<int>{19}, std::vector<Vec3f>{to});
    ASSERT_TRUE(world.step(dt).ok());
    largest = std::max(largest, world.measure().overstretch().largest);
  }
  EXPECT_LT(largest, 0.1);
}

}  // namespace
}  // namespace pliant
