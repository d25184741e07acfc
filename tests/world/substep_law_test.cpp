// Substeps that follow the State.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "pliant/error.h"
#include "world/substep_law_support.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(SubstepLaw, IsUsedWhereChainsAreSolvedAndTheSceneNamesNoSubsteps) {
  Scene scene = impact();
  EXPECT_EQ(chosen_sweep(scene, 0), Sweep::chains);
  EXPECT_EQ(chosen_substeps(scene), std::vector<int>{0});
  EXPECT_EQ(chosen_settings(scene).substeps, 0);
  EXPECT_EQ(World(scene).object({0}).info().substeps, 0);
  scene.settings.substeps = 15;
  EXPECT_EQ(chosen_substeps(scene), std::vector<int>{15});
  World world(scene);
  EXPECT_EQ(world.step(dt).substeps, 15);
  EXPECT_TRUE(world.state().substeps.empty());
}

TEST(SubstepLaw, IsNotUsedForRubberAndForConvertedStiffness) {
  Scene scene = impact();
  for (ConstraintGroup& group : scene.objects[0].constraints)
    if (group.type == "distance") group.stiffness = Stiffness::compliance(0.05f);
  EXPECT_EQ(chosen_substeps(scene), std::vector<int>{20});
  scene = impact();
  scene.objects[0].constraints.push_back({"dihedral_bending", {0, 1, 24, 25}, {}, Stiffness::pbd(0.5f), {}});
  EXPECT_EQ(chosen_substeps(scene), std::vector<int>{20});
}

/// At the impact the frame has several times the substeps of the fall and of rest.
TEST(SubstepLaw, TakesMoreSubstepsAtAnImpact) {
  World world(impact());
  std::vector<int> substeps;
  for (int frame = 0; frame < 150; ++frame) substeps.push_back(world.step(dt).substeps);
  const int before = *std::min_element(substeps.begin(), substeps.begin() + 17);
  const int at_impact = *std::max_element(substeps.begin() + 17, substeps.begin() + 40);
  EXPECT_LE(before, 16);
  EXPECT_GE(at_impact, 2 * before);
  EXPECT_LE(at_impact, 100);
  EXPECT_LT(substeps.back(), at_impact);
}

TEST(SubstepLaw, StaysWithinTheBoundsOfTheSettings) {
  Scene scene = impact();
  scene.settings.least_substeps = 17;
  scene.settings.most_substeps = 30;
  World world(scene);
  int least = 1000, most = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const int substeps = world.step(dt).substeps;
    least = std::min(least, substeps);
    most = std::max(most, substeps);
  }
  EXPECT_EQ(least, 20);  // whole numbers of substeps in a quarter
  EXPECT_EQ(most, 28);
}

/// What the default promises of cloth that meets surfaces; with 20 fixed substeps both are exceeded.
TEST(SubstepLaw, KeepsAnImpactWithinTwoPercent) {
  World world(impact(40));
  Overstretch worst;
  for (int frame = 0; frame < 80; ++frame) {
    world.step(dt);
    const Overstretch now = world.measure().overstretch();
    worst.p99 = std::max(worst.p99, now.p99);
    worst.largest = std::max(worst.largest, now.largest);
  }
  EXPECT_LE(worst.p99, 0.02);
  EXPECT_LE(worst.largest, 0.1);
}

TEST(SubstepLaw, GoesOnInTheSameBitsFromAState) {
  const Scene scene = impact();
  World one(scene);
  run(one, 20);
  const State kept = one.state();
  EXPECT_EQ(kept.substeps.size(), 1u);
  run(one, 20);
  World other(scene);
  other.restore(kept);
  run(other, 20);
  EXPECT_EQ(one.state_hash(), other.state_hash());
  State without = kept;
  without.substeps.clear();
  EXPECT_NE(hash(without), hash(kept));
  other.restore(without);
  run(other, 20);
  EXPECT_NE(one.state_hash(), other.state_hash());  // it starts with the cautious number
}

TEST(SubstepLaw, RefusesAStateWithSubstepsOfOtherObjects) {
  World world(impact());
  State state = world.state();
  state.substeps = {20, 20};
  EXPECT_THROW(world.restore(state), Error);
  state.substeps = {-1};
  EXPECT_THROW(world.restore(state), Error);
  state.substeps = {20000};
  EXPECT_THROW(world.restore(state), Error);
  state.substeps = {12};
  EXPECT_NO_THROW(world.restore(state));
}

/// Two sheets that can meet nothing but themselves: each has the bits that it has alone, whatever the other demands.
TEST(SubstepLaw, BelongsToASetOfObjects) {
  Scene both = impact();
  both.objects[0].collides = false;
  Object calm = falling_sheet(20);
  calm.name = "calm";
  calm.collides = false;
  for (Vec3f& p : calm.positions) p += Vec3f{5, 0, 0};
  Scene alone;
  alone.add(calm);
  alone.add(both.colliders[0]);
  both.add(calm);
  World world(both), other(alone);
  for (int frame = 0; frame < 40; ++frame) {
    ASSERT_TRUE(world.step(dt).ok());
    ASSERT_TRUE(other.step(dt).ok());
  }
  const std::vector<Vec3f> a = world.object({1}).positions(), b = other.object({0}).positions();
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)), 0);
  EXPECT_NE(world.state().substeps[0], world.state().substeps[1]);
}

TEST(SubstepLaw, SurvivesAdditionsAndRemovals) {
  Scene scene = impact();
  scene.objects[0].collides = false;
  World world(scene);
  run(world, 5);
  Object other = falling_sheet(20);
  other.collides = false;
  const ObjectId added = world.add(other);
  run(world, 5);
  EXPECT_EQ(world.state().substeps.size(), 2u);
  World again(
      scene =
          [&] {
            Scene with = scene;
            with.add(other);
            return with;
          }(),
      world.layout());
  again.restore(world.state());
  run(world, 5);
  run(again, 5);
  EXPECT_EQ(world.state_hash(), again.state_hash());
  world.remove(added);
  EXPECT_EQ(world.state().substeps[1], 0);
  run(world, 5);
}

/// What an object needs that does not follow the State, the others of its set grant.
TEST(SubstepLaw, GrantsWhatOtherSweepsOfTheSetNeed) {
  Scene scene = impact();
  Object other = falling_sheet(10);
  other.name = "tiled";
  other.sweep = Sweep::tiled;
  for (Vec3f& p : other.positions) p += Vec3f{5, 0, 0};
  scene.add(other);
  World world(scene);
  for (int frame = 0; frame < 15; ++frame) EXPECT_GE(world.step(dt).substeps, 20);  // free fall demands nothing
}

/// A rubber balloon that cloth can meet keeps its substeps, which are more than the law's largest number.
TEST(SubstepLaw, GrantsWhatVolumesOfTheSetNeed) {
  ClothOptions options{.volume = Volume{1.5f, Stiffness::rigid()}};
  options.material.area_density = 0.5f;
  options.material.stretch_stiffness = 1800;
  TriangleMesh mesh = sphere_mesh(3);
  for (Vec3f& p : mesh.positions) p = p * 0.2f + Vec3f{1, 0, 0};
  Scene scene;
  scene.add_cloth(mesh, options);
  const int alone = chosen_substeps(scene)[0];
  EXPECT_GT(alone, 100);
  scene.objects[0].collides = true;
  scene.add(falling_sheet(20));
  scene.objects[1].collides = true;
  EXPECT_EQ(chosen_substeps(scene), (std::vector<int>{0, 0}));
  World world(scene);
  for (int frame = 0; frame < 3; ++frame) EXPECT_GE(world.step(dt).substeps, alone);
  scene.settings.most_substeps = 100;
  EXPECT_EQ(World(scene).step(dt).substeps, 100) << "what the scene names holds";
}

/// The substeps of the last of five frames.
int substeps_after(const Scene& scene) {
  World world(scene);
  run(world, 4);
  return world.step(dt).substeps;
}

/// With 20 substeps, such sheets stretch by up to 4 % at this impact (p99).
TEST(SubstepLaw, HoldsSmallClothAtAnImpact) {
  for (const int n : {6, 10, 16, 24}) {
    Scene scene = impact(n);
    scene.objects[0].self_collision = true;
    scene.objects[0].velocities.assign(scene.objects[0].positions.size(), {0, -5, 0});
    EXPECT_EQ(chosen_substeps(scene), std::vector<int>{0});
    World world(scene);
    run(world, 30);
    const Overstretch worst = world.step(dt).worst_overstretch.overstretch;
    EXPECT_LE(worst.p99, 0.02) << n;
    EXPECT_LE(worst.largest, 0.1) << n;
  }
}

/// What hangs costs less than 20 substeps, however small it is.
TEST(SubstepLaw, SavesSubstepsWhereSmallClothHangs) {
  for (const int n : {6, 12}) {
    Scene scene;
    ClothOptions options;
    options.stretch = Stiffness::compliance(0);
    scene.add(sheet_at("cloth", {}, n, 1, options));
    scene.pin(0, {0, n - 1});
    EXPECT_LT(substeps_after(scene), 12) << n;
  }
}

/// The numbers of substeps of the frames of an impact.
std::pair<int, int> range_of_substeps(const Scene& scene) {
  World world(scene);
  int least = 10000, most = 0;
  for (int frame = 0; frame < 30; ++frame) {
    const int substeps = world.step(dt).substeps;
    least = std::min(least, substeps);
    most = std::max(most, substeps);
  }
  return {least, most};
}

TEST(SubstepLaw, ObeysALargestNumberBelowTheUsualLeast) {
  Scene scene = impact();
  for (const int most : {1, 3, 4, 8, 11}) {
    scene.settings.most_substeps = most;
    const int expected = most < 4 ? most : most / 4 * 4;
    EXPECT_EQ(range_of_substeps(scene), std::pair(expected, expected)) << most;
  }
}

TEST(SubstepLaw, RoundsBoundsInwards) {
  Scene scene = impact();
  scene.settings.least_substeps = 13;
  scene.settings.most_substeps = 16;
  EXPECT_EQ(range_of_substeps(scene), std::pair(16, 16));
  scene.settings.least_substeps = 5;
  scene.settings.most_substeps = 8;
  EXPECT_EQ(range_of_substeps(scene), std::pair(8, 8));
  scene.settings.least_substeps = 201;
  scene.settings.most_substeps = 0;
  EXPECT_EQ(range_of_substeps(scene), std::pair(204, 204));
}

TEST(SubstepLaw, RefusesBoundsWithoutAMultipleOfFour) {
  Scene scene = impact();
  for (const auto& [least, most] : {std::pair(48, 20), std::pair(13, 14), std::pair(5, 7)}) {
    scene.settings.least_substeps = least;
    scene.settings.most_substeps = most;
    EXPECT_THROW(World{scene}, Error) << least;
  }
}

TEST(SubstepLaw, KeepsItsNumberThroughAnEdit) {
  const Scene scene = impact();
  World world(scene);
  run(world, 17);
  const std::vector<float> before = world.state().substeps;
  world.edit({0}, unchanged(scene.objects[0]));
  EXPECT_EQ(world.state().substeps, before);
}

/// No number of substeps helps a constraint between two pins.
TEST(SubstepLaw, IgnoresConstraintsBetweenPins) {
  Scene scene;
  Object cloth = falling_sheet(30);
  cloth.pins.clear();
  for (int i = 0; i < 30; ++i) cloth.pins.push_back({i, {}});
  scene.add(cloth);
  World world(scene);
  std::vector<int> row;
  std::vector<Vec3f> spread;
  const std::vector<Vec3f> start = world.object({0}).positions();
  for (int i = 0; i < 30; ++i) {
    row.push_back(i);
    spread.push_back({start[static_cast<std::size_t>(i)].x, start[static_cast<std::size_t>(i)].y,
                      start[static_cast<std::size_t>(i)].z});
  }
  spread[15].y += 0.02f;  // two links of the row are now far too long
  world.object({0}).set_targets(row, spread);
  run(world, 400);
  EXPECT_LE(world.step(dt).substeps, 40);
}

TEST(SubstepLaw, ForgetsTheSubstepsOfWhatWasRemoved) {
  Scene scene = impact();
  scene.objects[0].collides = false;
  World world(scene);
  Object other = falling_sheet(20);
  other.collides = false;
  const ObjectId added = world.add(other);
  run(world, 5);
  EXPECT_GT(world.state().substeps.at(1), 0);
  world.remove(added);
  run(world, 5);
  EXPECT_EQ(world.state().substeps.at(1), 0);
  world.remove(ObjectId{0});
  EXPECT_TRUE(world.state().substeps.empty());
}

/// Multipliers that are stored only for a measurement must not change the motion.
TEST(SubstepLaw, DoesNotDependOnWhatIsMeasured) {
  for (const float compliance : {0.f, 1e-4f, 0.02f}) {
    Scene scene = impact();
    for (ConstraintGroup& group : scene.objects[0].constraints)
      if (group.type == "distance") group.stiffness = Stiffness::compliance(compliance);
    World plain(scene);
    run(plain, 40);
    for (bool Settings::*flag : {&Settings::measure, &Settings::record_multipliers}) {
      scene.settings.*flag = true;
      World other(scene);
      run(other, 40);
      EXPECT_EQ(plain.state_hash(), other.state_hash()) << compliance;
    }
  }
}

TEST(SubstepLaw, ReportsTheSubstepsMadeWhereClothHangs) {
  const int made = substeps_after(hung());
  EXPECT_GE(made, 6);
  EXPECT_LT(made, 12);
}

/// A strip that is 200 edges long needs 200^1.5 / 150 substeps, or an error at its end would not decay.
TEST(SubstepLaw, GrantsFineClothThatHangsMoreSubsteps) {
  EXPECT_LE(World(hung()).step(dt).substeps, 12);
  Scene scene;
  ClothOptions options;
  options.stretch = Stiffness::compliance(0);
  scene.add_cloth(grid_mesh(4, 201, 0.015f, 1), options);
  for (int i = 0; i < 4; ++i) scene.pin(0, {i});
  EXPECT_EQ(chosen_sweep(scene, 0), Sweep::tethered_chains);
  World world(scene);
  EXPECT_GE(world.step(dt).substeps, 16);
  scene.settings.least_substeps = 8;
  scene.settings.most_substeps = 12;
  EXPECT_LE(World(scene).step(dt).substeps, 12) << "named bounds hold";
}

/// The worst p99 of a run by default settings, and the most substeps of a frame.
double worst_p99(const Scene& scene, int frames, int& most) {
  World world(scene);
  double worst = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok());
    worst = report.worst_overstretch.overstretch.p99;
    most = std::max(most, report.substeps);
  }
  return worst;
}

/// With the substeps of cloth that hangs by two corners, 3.2 %: what swings about one moves fast.
TEST(SubstepLaw, HoldsClothThatSwingsAboutOneCorner) {
  Scene scene;
  ClothOptions options;
  options.stretch = Stiffness::rigid();
  Object cloth = sheet_at("cloth", {}, 32, 1, options);
  cloth.pins = {{0, {}}};
  scene.add(cloth);
  int most = 0;
  EXPECT_LT(worst_p99(scene, 100, most), 0.015);
}

/// With 100 substeps at most, 5.8 % when the end cracks.
TEST(SubstepLaw, HoldsARopeThatCracksLikeAWhip) {
  std::vector<Vec3f> points;
  for (int i = 0; i <= 1000; ++i) points.push_back({0.0015f * static_cast<float>(i), 0, 0});
  Scene scene;
  const int rope = scene.add(make_rope(points));
  scene.pin(rope, {0});
  int most = 0;
  EXPECT_LT(worst_p99(scene, 106, most), 0.02);
  EXPECT_GT(most, 100);
  EXPECT_LE(most, 200);
}

TEST(SubstepLaw, NeedsAnAnchorToHang) {
  Scene falls = hung();
  falls.objects[0].pins.clear();
  falls.settings.sweep = Sweep::tethered_chains;
  EXPECT_GE(substeps_after(falls), 12);
}

}  // namespace
}  // namespace pliant
