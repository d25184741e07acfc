// Tests fast motion against surfaces: nothing passes through at any speed, or the Report says that it may.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A small tetrahedron that keeps its shape.
Object pebble(const Vec3f& at, const Vec3f& velocity) {
  TriangleMesh mesh;
  const float s = 0.006f;
  mesh.positions = {at + Vec3f{s, s, s}, at + Vec3f{-s, -s, s}, at + Vec3f{-s, s, -s}, at + Vec3f{s, -s, -s}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  Object object = cloth(mesh, 0.0005f);
  object.self_collision = false;
  object.velocities.assign(4, velocity);
  object.masses.assign(4, 1e-5f);
  return object;
}

/// Shoots pebbles at 1 to 1000 m/s at cloth that is fixed at its border. Returns how many went through.
int shot_through(bool filter, std::size_t& crossings) {
  Scene scene = scene_of(10);
  scene.gravity = {};
  scene.settings.contact_filter = filter;
  const TriangleMesh mesh = sheet(16, 0.4f, 0);
  const int target = scene.add(cloth(mesh, 0.0005f));
  std::vector<int> border;
  for (int i = 0; i < 256; ++i)
    if (i < 16 || i >= 240 || i % 16 == 0 || i % 16 == 15) border.push_back(i);
  scene.pin(target, border);
  for (int k = 0; k < 16; ++k) {
    const float speed = std::pow(10.f, static_cast<float>(k) / 5), x = 0.08f * static_cast<float>(k % 4) - 0.113f;
    const Vec3f direction{0.2f, -0.97f, 0.1f}, aim{x, 0, 0.08f * static_cast<float>(k / 4) - 0.127f};
    Object stone = pebble(aim - direction * (0.02f + std::min(1.f, 0.05f * speed)), direction * speed);
    stone.groups = 2;  // they meet only the cloth, so that none is deflected on its way
    stone.mask = 1;
    scene.add(stone);
  }
  World world(scene);
  Watch watch(world, scene);
  for (int frame = 0; frame < 20; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    crossings += watch.crossings(world);
  }
  float lowest = 0;
  for (const Vec3f& p : world.object(target).positions()) lowest = std::min(lowest, p.y);
  int through = 0;
  for (int k = 0; k < 16; ++k) {
    // A pebble that slid over the border is below the cloth too. Its free flight back to the level of the cloth shows
    // where it passed.
    const Vec3f at = world.object(1 + k).positions()[0], v = world.object(1 + k).velocities()[0],
                passed = at - v * (at.y / v.y);
    if (at.y < lowest - 0.02f && std::abs(passed.x) < 0.2f && std::abs(passed.z) < 0.2f) ++through;
  }
  return through;
}

TEST(Shot, DoesNotPassThroughClothAtAnySpeed) {
  std::size_t crossings = 0;
  EXPECT_EQ(shot_through(true, crossings), 0);
  EXPECT_EQ(crossings, 0u);
}

TEST(Shot, PassesWithoutTheFilter) {
  std::size_t crossings = 0;
  EXPECT_GT(shot_through(false, crossings) + static_cast<int>(crossings), 0);
}

/// How far the middle of a sheet moves sideways, at most, after it was thrown straight down on cloth that is pinned
/// everywhere [m].
float drift_of_a_thrown_sheet(float speed, float friction, int vertices_across, int frames) {
  Scene scene = scene_of(10);
  const int base = scene.add(cloth(sheet(vertices_across, 0.6f, 0)));
  std::vector<int> all;
  for (int i = 0; i < vertices_across * vertices_across; ++i) all.push_back(i);
  scene.pin(base, all);
  Object thrown = cloth(sheet(16, 0.3f, 0.05f));
  thrown.velocities.assign(256, {0, -speed, 0});
  thrown.static_friction = thrown.kinetic_friction = friction;
  const int number = scene.add(thrown);
  World world(scene);
  float most = 0;
  for (int frame = 0; frame < frames; ++frame) {
    world.step(dt);
    Vec3f sum{};
    for (const Vec3f& p : world.object(number).positions()) sum += p;
    most = std::max(most, std::hypot(sum.x, sum.z) / 256);
  }
  return most;
}

/// All surfaces are level, so nothing may push the sheet sideways: neither friction nor the normals of contacts.
TEST(Thrown, DoesNotDriftSideways) {
  for (const float speed : {3.f, 10.f, 30.f})
    for (const int vertices_across : {24, 31}) {
      SCOPED_TRACE(std::to_string(speed) + " m/s on " + std::to_string(vertices_across));
      EXPECT_LT(drift_of_a_thrown_sheet(speed, 0.5f, vertices_across, 30), 0.001f);
      EXPECT_LT(drift_of_a_thrown_sheet(speed, 0, vertices_across, 30), 0.001f);
    }
}

/// A kinematic ball of triangles that moves through the place of a loose sheet.
struct Passage {
  std::size_t crossings = 0;
  std::int64_t unresolvable = 0;
  int most_substeps = 0;
  bool warned = false, said_dearer = false;
};

Passage ball_through(float speed, int most_substeps) {
  Scene scene = scene_of(20);
  scene.settings.most_substeps = most_substeps;
  scene.gravity = {};
  scene.add(cloth(sheet(14, 0.4f, 0)));
  MeshCollider ball;
  ball.mesh = sphere_mesh(2);
  for (Vec3f& p : ball.mesh.positions) p = p * 0.1f + Vec3f{0.011f, 0.12f, 0.007f};
  ball.motion = straight({0, -speed, 0}, 1);
  scene.add(ball);
  World world(scene);
  Watch watch(world, scene);
  Passage passage;
  for (int frame = 1; frame <= 10; ++frame) {
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok()) << report.explain();
    passage.unresolvable += report.pairs.unresolvable;
    passage.crossings += watch.crossings(world, {0, -speed * static_cast<float>(world.state().time), 0});
    passage.most_substeps = std::max(passage.most_substeps, report.substeps);
    const std::string dearer = "moves fast near object 'cloth': the frame has " + std::to_string(report.substeps) +
                               " substeps instead of 20 and takes about ";
    passage.said_dearer = passage.said_dearer || report.explain().find(dearer) != std::string::npos;
    passage.warned = passage.warned || report.explain().find("most_substeps") != std::string::npos;
  }
  return passage;
}

TEST(Shot, OfABallCarriesTheSheetAlong) {
  // In 20 substeps of 1/1200 s, a ball of 1 m/s moves 0.83 mm per substep; half the pair's thickness is 1 mm.
  for (const auto& [speed, substeps] : {std::pair{1.f, 20}, {3.f, 50}, {10.f, 167}, {30.f, 500}}) {
    const Passage passage = ball_through(speed, 2000);
    EXPECT_EQ(passage.crossings, 0u) << speed << " m/s";
    EXPECT_EQ(passage.unresolvable, 0) << speed << " m/s";
    EXPECT_NEAR(passage.most_substeps, substeps, 1) << speed << " m/s";
    EXPECT_FALSE(passage.warned) << speed << " m/s";
  }
}

/// Two sheets, the second one fixed at its corners, that hold up a ball which is driven into them.
TEST(Shot, OfABallDrivesOneSheetIntoAnotherAndThroughNeither) {
  for (const Sweep sweep : {Sweep::tiled, Sweep::symmetric}) {
    Scene scene = scene_of(20);
    scene.settings.sweep = sweep;
    scene.settings.most_substeps = 2000;
    scene.gravity = {};
    scene.add(cloth(sheet(12, 0.4f, 0), 0.003f));
    scene.pin(scene.add(cloth(sheet(12, 0.4f, -0.02f), 0.003f)), {0, 11, 132, 143});
    MeshCollider ball;
    ball.mesh = sphere_mesh(2);
    for (Vec3f& p : ball.mesh.positions) p = p * 0.08f + Vec3f{0.011f, 0.1f, 0.007f};
    ball.motion = straight({0, -10, 0}, 1);
    scene.add(ball);
    World world(scene);
    Watch watch(world, scene);
    for (int frame = 1; frame <= 1; ++frame) {
      const Report report = world.step(dt);
      EXPECT_EQ(report.pairs.unresolvable, 0) << "frame " << frame << ": " << report.explain();
      EXPECT_EQ(watch.crossings(world, {0, -10 * static_cast<float>(world.state().time), 0}), 0u) << "frame " << frame;
    }
  }
}

TEST(Shot, OfABallThatOverrunsTheSheetIsSaidToBe) {
  // The filter cannot limit a kinematic collider that moves farther in a substep than the gap.
  for (const float speed : {10.f, 100.f, 1000.f}) {
    const Passage passage = ball_through(speed, 20);
    EXPECT_TRUE(passage.crossings == 0 || passage.unresolvable > 0) << speed << " m/s";
    EXPECT_TRUE(passage.warned) << speed << " m/s";
    EXPECT_EQ(passage.most_substeps, 20) << speed << " m/s";
  }
}

/// By default a frame gets at most eight times the substeps, and the Report says why it takes so
/// long.
TEST(Shot, OfABallMakesAFrameEightTimesDearerAtMostAndTheReportSaysSo) {
  for (const auto& [speed, substeps] : {std::pair{1.f, 20}, {3.f, 50}, {30.f, 160}}) {
    const Passage passage = ball_through(speed, 0);
    EXPECT_NEAR(passage.most_substeps, substeps, substeps == 50 ? 1 : 0) << speed << " m/s";
    EXPECT_EQ(passage.said_dearer, substeps > 20) << speed << " m/s";
    EXPECT_EQ(passage.warned, speed == 30) << "that it may pass at " << speed << " m/s";
  }
}

TEST(Shot, OfABallThatMissesCostsNoSubsteps) {
  Scene scene = scene_of(20);
  scene.gravity = {};
  scene.add(cloth(sheet(14, 0.4f, 0)));
  MeshCollider ball;
  ball.mesh = sphere_mesh(2);
  for (Vec3f& p : ball.mesh.positions) p = p * 0.1f + Vec3f{0.011f, 0.4f, 0.007f};
  ball.motion = straight({10, 0, 0}, 1);
  scene.add(ball);
  World world(scene);
  for (int frame = 0; frame < 10; ++frame) EXPECT_EQ(world.step(dt).substeps, 20);
}

}  // namespace
}  // namespace pliant
