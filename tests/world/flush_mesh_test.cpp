// Tests that particles, grains, ropes and cloth keep speed, direction and height on flat meshes, one or several that
// are flush, that friction brakes them as on a plane, and that ridges still stop them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "math/quat.h"
#include "math/vector.h"
#include "pliant/grains.h"
#include "pliant/random.h"
#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// The matter that slides, `thickness` above the ground at least, about the origin.
Object slider(const std::string& kind, float thickness, float height) {
  Object object;
  if (kind == "cloth") {
    object = cloth(sheet(6, 0.25f, height), thickness);
  } else if (kind == "rope") {
    std::vector<Vec3f> points;
    for (int i = 0; i < 6; ++i)
      points.push_back({0.05f * static_cast<float>(i) - 0.13f, height, 0.02f * static_cast<float>(i)});
    object = make_rope(points);
  } else if (kind == "grains") {
    object = make_grains({{0, height, 0}, {0.11f, height, 0.17f}}, {.grains = {.radius = thickness}});
  } else {
    object.positions = {{0, height, 0}, {0.11f, height, 0.17f}};
    object.masses = {0.01f, 0.01f};
  }
  if (kind != "grains") object.thickness = thickness;
  object.collides = true;
  object.static_friction = object.kinetic_friction = 0;
  return object;
}

/// Level ground of edges of random length, turned at random: `tiles` meshes that are flush side by side.
void add_ground(Random& random, int tiles, float friction, Scene& scene) {
  constexpr float half = 4;
  const Quatf turned = Quatf{0, std::sin(random.between(0, 3)), 0, 0};
  const Quatf yaw{0, turned.y, 0, std::sqrt(1 - turned.y * turned.y)};
  const float width = 2 * half / static_cast<float>(tiles);
  const int rows = static_cast<int>(random.between(18, 90));
  for (int tile = 0; tile < tiles; ++tile) {
    MeshCollider ground;
    ground.name = "ground" + std::to_string(tile);
    ground.mesh = grid_mesh(2 + rows / tiles, 2 + rows + tile, width, 2 * half);
    for (Vec3f& p : ground.mesh.positions)
      p = rotate(yaw, p + Vec3f{(static_cast<float>(tile) + 0.5f) * width - half, 0, 0});
    ground.static_friction = ground.kinetic_friction = friction;
    scene.add(ground);
  }
}

struct Slid {
  Vec3f velocity{};
  float lowest = 1e9f, highest = -1e9f;
};

Slid slid(const Scene& scene, int frames) {
  World world(scene);
  for (int frame = 0; frame < frames; ++frame) EXPECT_TRUE(world.step(dt).ok());
  Slid out;
  const std::vector<Vec3f> places = world.object(0).positions(), velocities = world.object(0).velocities();
  for (const Vec3f& v : velocities) out.velocity += v * (1 / static_cast<float>(velocities.size()));
  for (const Vec3f& p : places) {
    out.lowest = std::min(out.lowest, p.y);
    out.highest = std::max(out.highest, p.y);
  }
  return out;
}

class SlidesOnMeshes : public ::testing::TestWithParam<const char*> {};

TEST_P(SlidesOnMeshes, AtTheSameSpeedAndHeight) {
  Random random(2026);
  for (int i = 0; i < 8; ++i) {
    const float thickness = random.between(0.003f, 0.02f), speed = i % 2 == 0 ? 2 : random.between(1, 20),
                angle = random.between(0, 6.2831853f);
    const Vec3f velocity{speed * std::cos(angle), 0, speed * std::sin(angle)};
    Scene scene;
    Object object = slider(GetParam(), thickness, i % 3 == 1 ? 1.05f * thickness : thickness);
    object.velocities.assign(object.positions.size(), velocity);
    scene.add(object);
    const int tiles = 1 + i % 4;
    add_ground(random, tiles, 0, scene);
    scene.settings.threads = 1;
    const Slid found = slid(scene, std::min(20, static_cast<int>(3 / speed / dt)));
    const std::string what =
        std::to_string(i) + ": thickness " + std::to_string(thickness) + " at " + std::to_string(speed);
    EXPECT_LT(length(found.velocity - velocity), 1e-3f * speed) << what << ", now " << length(found.velocity);
    EXPECT_NEAR(found.lowest, thickness, 1e-4f) << what;
    EXPECT_NEAR(found.highest, thickness, 1e-4f) << what;
  }
}

TEST_P(SlidesOnMeshes, AsFrictionBrakes) {
  Random random(7);
  constexpr float friction = 0.2f, speed = 3;
  for (const int tiles : {1, 3}) {
    Scene scene;
    Object object = slider(GetParam(), 0.01f, 0.01f);
    object.velocities.assign(object.positions.size(), {speed, 0, 0});
    object.static_friction = object.kinetic_friction = friction;
    scene.add(object);
    add_ground(random, tiles, friction, scene);
    scene.settings.threads = 1;
    EXPECT_NEAR(slid(scene, 30).velocity.x, speed - friction * 9.81f * 0.5f, 0.01f * speed);
  }
}

/// A ridge of a mesh, 0.1 m high, at x = 0.6: a speed of 1 m/s climbs half of it.
TEST_P(SlidesOnMeshes, UpToARidge) {
  Scene scene;
  Object object = slider(GetParam(), 0.01f, 0.01f);
  object.velocities.assign(object.positions.size(), {1, 0, 0});
  scene.add(object);
  MeshCollider ground;
  ground.mesh = grid_mesh(41, 21, 4, 4);
  for (Vec3f& p : ground.mesh.positions) p.y = std::max(0.f, 0.1f - std::abs(p.x - 0.6f));
  ground.static_friction = ground.kinetic_friction = 0;
  scene.add(ground);
  scene.settings.threads = 1;
  World world(scene);
  float farthest = -1;
  for (int frame = 0; frame < 90; ++frame) {
    ASSERT_TRUE(world.step(dt).ok());
    for (const Vec3f& p : world.object(0).positions()) {
      farthest = std::max(farthest, p.x);
      ASSERT_GT(p.y, std::max(0.f, 0.1f - std::abs(p.x - 0.6f))) << "frame " << frame;
    }
  }
  EXPECT_GT(farthest, 0.5f);
  EXPECT_LT(farthest, 0.6f);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SlidesOnMeshes, ::testing::Values("particles", "grains", "rope", "cloth"),
                         [](const auto& kind_of_test) { return std::string(kind_of_test.param); });

}  // namespace
}  // namespace pliant
