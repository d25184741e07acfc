// Tests bodies that overlap at the start: they are moved apart slowly, and the Report names them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "geometry/polyhedron_contact.h"
#include "math/vector.h"
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

/// Without a limit the fastest had 38 m/s; with it 6 to 9.5 by the number of boxes (150 to 250). They still leave with
/// 3 m/s on average: contacts cannot pull back what others have pushed.
TEST(OverlappingBodies, BoxesInOnePlaceSeparateWithoutAnExplosion) {
  World world(coincident_boxes(200));
  const Watched all = watched_run(world, 600);
  EXPECT_LT(all.fastest, 10);
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

/// Bodies in a column fall on a plane, one behind another at the same speed. Within one frame the first one is stopped,
/// and with it those that follow. Before, they had gone into one another by up to 51 mm when contact began. What
/// remains is how far 8 substeps press them in.
TEST(OverlappingBodies, WhatFollowsABodyThatIsStoppedDoesNotGoIntoIt) {
  for (const float speed : {3.f, 5.f, 6.f}) {
    Scene scene;
    scene.colliders.emplace_back();
    Object column;
    column.name = "column";
    for (int i = 0; i < 4; ++i) {
      BodyOptions options;
      options.position = {0, 0.2f + 0.11f * static_cast<float>(i), 0};
      options.velocity = {0, -speed, 0};
      add_body(column, {{Sphere{0.045f}}}, options);
    }
    scene.add(column);
    World world(scene);
    for (int frame = 0; frame < 30; ++frame) {
      EXPECT_TRUE(world.step(dt).ok());
      const std::vector<Vec3f> at = world.object(0).positions();
      for (std::size_t i = 0; i + 1 < at.size(); ++i)
        EXPECT_GT(length(at[i + 1] - at[i]), 0.09f - 3e-3f) << speed << " " << frame << " " << i;
    }
  }
}

/// How far two boxes of equal size overlap along the axis that separates them best [m].
float overlap_of(const RigidPose& a, const RigidPose& b, const Vec3f& half) {
  const Polyhedron box = polyhedron_of_box(half);
  const Polyhedron one = moved(box, Posef{a.position, a.rotation}), other = moved(box, Posef{b.position, b.rotation});
  return -separating_axis(one, other).separation;
}

/// Slabs that lean on one another a little askew touch at an edge, and turn about it. Before, they had this one
/// contact, and went through one another: 8.6 mm of a thickness of 7.4 mm.
TEST(OverlappingBodies, DominoesOnACurveDoNotGoIntoOneAnother) {
  const Vec3f half{0.012f, 0.024f, 0.0037f};
  Scene scene;
  scene.colliders.emplace_back();
  Object row;
  row.static_friction = 0.3f, row.kinetic_friction = 0.25f;
  constexpr int count = 14;
  for (int i = 0; i < count; ++i) {
    const float angle = 0.2f * static_cast<float>(i);
    BodyOptions options;
    options.position = {0.11f * std::cos(angle), half.y + 1e-4f, 0.11f * std::sin(angle)};
    options.rotation = Quatf{0, std::sin(-0.5f * angle), 0, std::cos(0.5f * angle)};
    if (i == 0) options.angular_velocity = {12, 0, 0};
    add_body(row, {{Box{half}}}, options);
  }
  scene.add(row);
  World world(scene);
  float deepest = 0;
  for (int frame = 0; frame < 90; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    for (int i = 0; i + 1 < count; ++i)
      deepest = std::max(deepest, overlap_of(world.object(0).pose(i), world.object(0).pose(i + 1), half));
  }
  EXPECT_LT(world.object(0).positions().back().y, 0.02f) << "the last one fell";
  EXPECT_LT(deepest, 0.6f * half.z);
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
