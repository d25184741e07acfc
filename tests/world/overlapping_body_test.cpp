// Tests bodies that overlap at the start: they are moved apart slowly, and the Report names them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/world.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;
using testing_support::fastest;

/// The speed of the fastest body in any frame, and what the Reports of all frames warn of [m/s].
struct Watched {
  float fastest = 0, last = 0;
  std::string warnings;
};

Watched watched_run(World& world, int frames) {
  Watched all;
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok());
    for (const std::string& warning : report.warnings) all.warnings += warning + "\n";
    all.last = fastest(world);
    all.fastest = std::max(all.fastest, all.last);
  }
  return all;
}

/// Cubes above one another, each half in the one below it.
Scene half_overlapping_tower(int count, float side) {
  Scene scene;
  scene.colliders.emplace_back();
  scene.colliders.back().static_friction = scene.colliders.back().kinetic_friction = 0.6f;
  Object tower;
  tower.name = "tower";
  tower.static_friction = tower.kinetic_friction = 0.6f;
  for (int i = 0; i < count; ++i) {
    BodyOptions options;
    options.position = {0, side * (0.5f + 0.5f * static_cast<float>(i)), 0};
    add_body(tower, {{Box{{0.5f * side, 0.5f * side, 0.5f * side}}}}, options);
  }
  scene.add(tower);
  return scene;
}

TEST(OverlappingBodies, ATowerOfHalfOverlappingCubesRisesSlowlyAndStands) {
  for (const float side : {1.f, 0.1f}) {
    World world(half_overlapping_tower(10, side));
    const Watched all = watched_run(world, 600);
    EXPECT_LT(all.fastest, 2.5f * std::sqrt(side)) << side;
    EXPECT_LT(all.last, 1e-3f) << side;
    for (int i = 0; i < 10; ++i) {
      const Vec3f at = world.object(0).positions()[static_cast<std::size_t>(i)];
      EXPECT_NEAR(at.y, side * (0.5f + static_cast<float>(i)), 0.05f * side) << side << " " << i;
      EXPECT_LT(std::hypot(at.x, at.z), 0.05f * side) << side << " " << i;
    }
  }
}

Scene coincident_boxes(int count) {
  Scene scene;
  scene.gravity = {};
  Object pile;
  pile.name = "pile";
  for (int i = 0; i < count; ++i) add_body(pile, {{Box{}}});
  scene.add(pile);
  return scene;
}

/// Without a limit the fastest had 38 m/s. They still leave with 3 m/s on average: contacts cannot pull back what others have pushed.
TEST(OverlappingBodies, BoxesInOnePlaceSeparateWithoutAnExplosion) {
  World world(coincident_boxes(200));
  const Watched all = watched_run(world, 600);
  EXPECT_LT(all.fastest, 6);
  const std::vector<Vec3f> at = world.object(0).positions();
  double mean = 0;
  for (const Vec3f& p : at) mean += std::sqrt(static_cast<double>(length_squared(p))) / 200;
  EXPECT_GT(mean, 2) << "a ball of 200 cubic metres has a mean radius of 2.7 m";
}

TEST(OverlappingBodies, TheReportNamesThemAndHowDeep) {
  World world(half_overlapping_tower(10, 1));
  const Report first = world.step(dt);
  ASSERT_EQ(first.warnings.size(), 1U);
  EXPECT_NE(first.warnings[0].find("9 pairs of bodies overlap"), std::string::npos) << first.warnings[0];
  EXPECT_NE(first.warnings[0].find("of 'tower' by 0.500"), std::string::npos) << first.warnings[0];
  const Watched rest = watched_run(world, 300);
  EXPECT_EQ(rest.warnings.find("too heavy"), std::string::npos) << rest.warnings;
}

TEST(OverlappingBodies, ARestoredWorldGoesOnWithTheSameBits) {
  const Scene scene = half_overlapping_tower(6, 1);
  World world(scene);
  watched_run(world, 30);
  World other(scene);
  other.restore(world.state());
  watched_run(world, 30);
  watched_run(other, 30);
  EXPECT_EQ(world.state_hash(), other.state_hash());
}

/// Heavy bodies that rest on light ones press contacts deep, too, but these are borne as ever.
TEST(OverlappingBodies, WeightIsNoOverlapAtTheStart) {
  Scene scene = half_overlapping_tower(1, 1);
  BodyOptions options;
  options.position = {0, 1.5f, 0};
  options.mass = 300000;
  scene.add(make_body({{Box{{0.5f, 0.5f, 0.5f}}}}, options));
  World world(scene);
  EXPECT_EQ(watched_run(world, 240).warnings.find("pairs of bodies overlap"), std::string::npos);
}

}  // namespace
}  // namespace pliant
