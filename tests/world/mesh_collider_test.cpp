// Tests mesh colliders: how they move and deform, contact with single particles, and the contact properties of pairs:
// bounce, friction and thickness compared with formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/untangle/intersections.h"
#include "math/vector.h"
#include "pliant/error.h"
#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;

MeshCollider floor_of_triangles() {
  MeshCollider floor;
  floor.name = "floor";
  floor.mesh = grid_mesh(5, 5, 2, 2);
  return floor;
}

// ------------------------------------------------------------------------------------------------ what deforms

/// A floor whose middle rises by 0.2 m in half a second below a sheet that lies on it.
TEST(DeformingMesh, LiftsWhatLiesOnIt) {
  Scene scene = scene_of(10);
  MeshCollider ground;
  ground.mesh = grid_mesh(9, 9, 1, 1);
  ground.frames = {{0.2f, ground.mesh.positions}, {0.7f, ground.mesh.positions}};
  for (Vec3f& p : ground.frames[1].positions) p.y += 0.2f * std::max(0.f, 1 - 3 * length(p));
  scene.add(ground);
  scene.add(cloth(sheet(12, 0.5f, 0.003f)));
  World world(scene);
  std::vector<Triangle> triangles;
  for (const auto& t : world.object(0).mesh().triangles) triangles.push_back({t[0], t[1], t[2]});
  for (const auto& t : ground.mesh.triangles) triangles.push_back({144 + t[0], 144 + t[1], 144 + t[2]});
  IntersectionFinder finder(triangles, 144 + 81);
  for (int frame = 0; frame < 60; ++frame) {
    const Report report = world.step(dt);
    ASSERT_EQ(report.pairs.unresolvable, 0) << "frame " << frame;
    std::vector<Vec3f> places = world.object(0).positions();
    const std::vector<Vec3f> deformed = world.mesh_collider(0).positions();
    places.insert(places.end(), deformed.begin(), deformed.end());
    ASSERT_EQ(finder.find(places).size(), 0u) << "frame " << frame;
    const double rise = 0.2 * std::clamp((world.state().time - 0.2) / 0.5, 0., 1.);
    EXPECT_NEAR(deformed[40].y, rise, 1e-6) << "frame " << frame;
  }
  float highest = 0;
  for (const Vec3f& p : world.object(0).positions()) highest = std::max(highest, p.y);
  EXPECT_GT(highest, 0.15f);
  EXPECT_LT(highest, 0.25f);
}

TEST(DeformingMesh, IsCarriedByItsMotionToo) {
  Scene scene = scene_of(2);
  MeshCollider one;
  one.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  one.frames = {{0, one.mesh.positions}, {1, {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}}};
  one.repeat_frames = true;
  one.motion = straight({30, 0, 0}, 10);
  one.motion.pivot = {7, 7, 7};
  scene.add(one);
  World world(scene);
  EXPECT_EQ(world.mesh_collider(0).positions()[1], (Vec3f{1, 0, 0}));
  for (int frame = 0; frame < 90; ++frame) world.step(dt);
  const Vec3f at = world.mesh_collider(0).positions()[1];  // after 1.5 s: half of the second period
  EXPECT_NEAR(at.x, 1 + 4.5f, 1e-5f);
  EXPECT_NEAR(at.z, 1.f, 1e-5f);
}

TEST(MeshCollider, BeginsWhereItsKeyframesHaveIt) {
  Scene scene = scene_of(2);
  MeshCollider one;
  one.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  one.motion.keyframes = {{0, {0, 5, 0}, {}}, {1, {0, 6, 0}, {}}};
  scene.add(one);
  World world(scene);
  EXPECT_EQ(world.mesh_collider(0).positions()[0], (Vec3f{0, 5, 0}));
  world.step(dt);
  EXPECT_NEAR(world.mesh_collider(0).positions()[0].y, 5 + double(dt), 1e-6);
}

// ------------------------------------------------------------------------------------------------ single particles

/// Particles shot at a mesh from all sides, fast and slow. Returns how many are inside it after some time.
int grains_inside(float thickness) {
  Scene scene = scene_of(4);
  scene.gravity = {};
  MeshCollider ball;
  ball.mesh = sphere_mesh(3);
  ball.static_friction = ball.kinetic_friction = 0;
  scene.add(ball);
  std::vector<Vec3f> places, speeds;
  for (int i = 0; i < 60; ++i) {
    const float a = 2.39996f * static_cast<float>(i), y = 1 - (2 * static_cast<float>(i) + 1) / 60,
                r = std::sqrt(1 - y * y);
    const Vec3f out{r * std::cos(a), y, r * std::sin(a)};
    places.push_back(1.5f * out);
    speeds.push_back(-std::pow(10.f, static_cast<float>(i % 4)) * out);
  }
  Object grains = loose_particles(places, speeds);
  grains.thickness = thickness;
  scene.add(grains);
  World world(scene);
  int inside = 0;
  for (int frame = 0; frame < 60; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    for (const Vec3f& p : world.object(0).positions())
      inside += length(p) < 0.98f ? 1 : 0;  // the mesh is inscribed in the ball, so it is a little smaller
  }
  return inside;
}

TEST(SingleParticles, DoNotPassThroughAMesh) { EXPECT_EQ(grains_inside(0.005f), 0); }

TEST(SingleParticles, ComeToRestOnAMesh) {
  Scene scene = scene_of(10);
  scene.add(floor_of_triangles());
  Object grains = loose_particles({{0.1f, 0.2f, 0.13f}, {0.37f, 0.5f, -0.2f}, {1.4f, 0.1f, 0}});
  grains.thickness = 0.01f;
  scene.add(grains);
  World world(scene);
  for (int frame = 0; frame < 120; ++frame) world.step(dt);
  EXPECT_NEAR(world.object(0).positions()[0].y, 0.01f, 1e-4f);
  EXPECT_NEAR(world.object(0).positions()[1].y, 0.01f, 1e-4f);
  EXPECT_LT(world.object(0).positions()[2].y, -10.f);  // it falls beside the mesh
}

TEST(SingleParticles, MeetClothThatCollides) {
  Scene scene = scene_of(10);
  Object held = cloth(sheet(6, 0.4f, 0));
  held.masses.assign(36, std::numeric_limits<float>::infinity());
  scene.add(held);
  Object grains = loose_particles({{0.03f, 0.1f, 0.02f}});
  grains.collides = true;
  grains.thickness = 0.003f;
  scene.add(grains);
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  EXPECT_NEAR(world.object(1).positions()[0].y, 0.005f, 1e-4f);
}

// ------------------------------------------------------------------------------------------------ what two are to one another

/// How high a patch rises again that falls flat from 0.5 m onto triangles [m].
float bounce(float object, float collider, std::optional<float> pair) {
  Scene scene = scene_of(20);
  MeshCollider floor = floor_of_triangles();
  floor.restitution = collider;
  scene.add(floor);
  Object patch = cloth(sheet(3, 0.2f, 0.5f), 0.002f);
  patch.restitution = object;
  scene.add(patch);
  if (pair) scene.pairs.push_back({"floor", patch.name, {}, {}, {}, pair});
  World world(scene);
  bool rises = false;
  float highest = 0, last = 1;
  for (int frame = 0; frame < 55; ++frame) {
    world.step(dt);
    const float height = world.object(0).positions()[4].y;
    rises = rises || height >= last;
    last = height;
    if (rises) highest = std::max(highest, height);
  }
  return highest;
}

TEST(Restitution, OfSurfacesIsTheLargerOfBothOrThePairsOwn) {
  const double fall = 0.5 - 0.002;
  EXPECT_LT(bounce(0, 0, {}), 0.003f);
  EXPECT_NEAR(double(bounce(0.5f, 0, {})), 0.002 + 0.25 * fall, 0.01);
  EXPECT_NEAR(double(bounce(0.2f, 0.5f, {})), 0.002 + 0.25 * fall, 0.01);
  EXPECT_NEAR(double(bounce(0.1f, 0, 0.6f)), 0.002 + 0.36 * fall, 0.01);
  EXPECT_LT(bounce(0.5f, 0.5f, 0.f), 0.003f);
}

TEST(Restitution, OfTwoPatchesKeepsMomentumAndTheShareOfSpeed) {
  Scene scene = scene_of(10);
  scene.gravity = {};
  for (const float side : {-1.f, 1.f}) {
    Object patch = cloth(sheet(3, 0.2f, side * 0.05f));
    patch.name = side < 0 ? "lower" : "upper";
    patch.self_collision = false;
    patch.restitution = 0.5f;
    for (float& mass : patch.masses) mass *= side < 0 ? 1.f : 3.f;
    patch.velocities.assign(9, Vec3f{0, side < 0 ? 1.f : -1.f, 0});
    scene.add(patch);
  }
  World world(scene);
  for (int frame = 0; frame < 12; ++frame) world.step(dt);
  double speed[2]{};
  for (int o = 0; o < 2; ++o)
    for (const Vec3f& v : world.object(o).velocities()) speed[o] += double(v.y) / 9;
  EXPECT_NEAR(speed[1] - speed[0], 0.5 * 2, 0.05);
  EXPECT_NEAR((speed[0] + 3 * speed[1]) / 4, -0.5, 1e-3);
}

TEST(Pairs, HaveAThicknessAndFrictionOfTheirOwn) {
  const auto run = [](const PairProperties& pair) {
    Scene scene = scene_of(10);
    scene.gravity = {1, -9.81f, 0};
    scene.add(floor_of_triangles());
    Object patch = cloth(sheet(4, 0.2f, 0.012f));
    patch.name = "patch";
    patch.static_friction = patch.kinetic_friction = 1;
    scene.add(patch);
    if (!pair.first.empty()) scene.pairs = {pair};
    World world(scene);
    for (int frame = 0; frame < 60; ++frame) world.step(dt);
    Vec3f mean{};
    for (const Vec3f& p : world.object(0).positions()) mean += p * (1.f / 16);
    return mean;
  };
  EXPECT_NEAR(run({}).y, 0.002f, 1e-4f);
  EXPECT_LT(run({}).x, 0.01f);  // 1 / 9.81 is less than the coefficient, which is the mean of 1 and 0.4
  EXPECT_NEAR(run({"patch", "floor", 0.01f, {}, {}, {}}).y, 0.01f, 1e-4f);
  EXPECT_NEAR(run({"floor", "patch", {}, 0.f, {}, {}}).x, 0.5f, 0.02f);      // slides as if there were no friction
  EXPECT_NEAR(run({"patch", "patch", 0.1f, 0.f, {}, {}}).y, 0.002f, 1e-4f);  // the patch with itself
}

TEST(Pairs, AreRefusedWhereTheyNameNobody) {
  Scene scene = scene_of(2);
  scene.add(floor_of_triangles());
  scene.pairs = {{"floor", "nobody", {}, {}, {}, {}}};
  try {
    World world(scene);
    FAIL() << "was made";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "pair 0: names 'nobody', which is not an object or mesh collider; use the name of one");
  }
}

}  // namespace
}  // namespace pliant
