// Tests flat bodies that are thrown down: within a frame the far side of a coin that tips over meets the ground too.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "math/quat.h"
#include "pliant/body.h"
#include "pliant/mesh.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// Fifty tumbled copies of a solid, apart from one another.
Object tumbled(const SolidShape& shape, float apart, float height) {
  Object object;
  for (int i = 0; i < 50; ++i) {
    BodyOptions options;
    const auto x = static_cast<float>(i % 10), z = static_cast<float>(i / 10), turn = static_cast<float>(i);
    options.position = {apart * (x - 4.5f), height, apart * (z - 2)};
    const Vec3f axis{std::sin(3 * turn), std::cos(5 * turn), std::sin(7 * turn + 1)};
    const float half = 0.5f * turn, size = std::sqrt(length_squared(axis)), s = std::sin(half) / size;
    options.rotation = {axis.x * s, axis.y * s, axis.z * s, std::cos(half)};
    add_body(object, {{shape}}, options);
  }
  return object;
}

enum class Ground { plane, box, mesh };

/// The lowest centre of the bodies after four seconds [m].
float lowest_after_a_fall(const SolidShape& shape, float apart, float height, Ground ground) {
  Scene scene;
  scene.settings.threads = 1;
  Collider collider;
  collider.position = {0, ground == Ground::box ? -0.5f : 0, 0};
  if (ground == Ground::box) collider.shape = Box{{50, 0.5f, 50}};
  if (ground == Ground::mesh) {
    MeshCollider mesh;
    mesh.mesh = grid_mesh(21, 21, 20, 20);
    scene.mesh_colliders.push_back(mesh);
  } else {
    scene.add(collider);
  }
  scene.add(tumbled(shape, apart, height));
  World world(scene);
  for (int frame = 0; frame < 240; ++frame) EXPECT_TRUE(world.step(1.f / 60).ok());
  float lowest = 1e30f;
  for (const Vec3f& p : world.object(0).positions()) lowest = std::min(lowest, p.y);
  return lowest;
}

TEST(FlatBody, DoesNotSinkIntoTheGround) {
  for (const Ground ground : {Ground::plane, Ground::box, Ground::mesh}) {
    const std::string on = "ground " + std::to_string(static_cast<int>(ground));
    EXPECT_GT(lowest_after_a_fall(Cylinder{0.1f, 0.02f}, 0.4f, 0.3f, ground), 0.018f) << on;
    EXPECT_GT(lowest_after_a_fall(Box{{0.1f, 0.02f, 0.1f}}, 0.5f, 0.3f, ground), 0.018f) << on;
  }
}

/// A coin of 24 mm: thinner than what a rim moves in a frame.
TEST(FlatBody, ACoinDoesNotSinkIntoThePlane) {
  EXPECT_GT(lowest_after_a_fall(Cylinder{0.012f, 0.001f}, 0.05f, 0.12f, Ground::plane), 0.0005f);
}

/// How deep the lowest corner of a box goes below the plane while it tips over, let go at an angle with a spin [m].
float deepest_of_a_box_that_tips_over(const Vec3f& half, float angle, float spin) {
  Scene scene;
  scene.settings.threads = 1;
  scene.add(Collider{});
  BodyOptions options;
  options.rotation = {std::sin(angle / 2), 0, 0, std::cos(angle / 2)};
  options.position = {0, half.y * std::cos(angle) + half.z * std::sin(angle) + 0.001f, 0};
  options.angular_velocity = {spin, 0, 0};
  scene.add(make_body({{Box{half}}}, options));
  World world(scene);
  float deepest = 0;
  for (int frame = 0; frame < 120; ++frame) {
    EXPECT_TRUE(world.step(1.f / 60).ok());
    const RigidPose pose = world.object(0).pose(0);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3f at{(corner & 1) != 0 ? half.x : -half.x, (corner & 2) != 0 ? half.y : -half.y,
                     (corner & 4) != 0 ? half.z : -half.z};
      deepest = std::max(deepest, -(pose.position + rotate(pose.rotation, at)).y);
    }
  }
  return deepest;
}

/// A box that tips over stays on the edge about which it turns, however fast it is: 2 m of plank sank by 25 cm,
/// dominoes by 18 of 24 mm.
TEST(FlatBody, ABoxThatTipsOverStaysAboveThePlane) {
  for (const float spin : {0.f, 1.f, 2.f, 4.f})
    EXPECT_LT(deepest_of_a_box_that_tips_over({0.2f, 1, 0.05f}, 0.35f, spin), 0.01f) << spin;
  for (const float spin : {3.f, 4.f, 6.f})
    EXPECT_LT(deepest_of_a_box_that_tips_over({0.12f, 0.24f, 0.037f}, 0, spin), 0.0037f) << spin;
  for (const float spin : {9.f, 12.f})
    EXPECT_LT(deepest_of_a_box_that_tips_over({0.012f, 0.024f, 0.0037f}, 0, spin), 0.0011f) << spin;
}

/// How far a box at rest gets that is suddenly pushed towards a wall, 15 cm ahead in the mesh on whose floor it stands
/// [m].
float farthest_after_a_push(float speed) {
  Scene scene;
  scene.settings.threads = 1;
  MeshCollider room;
  room.mesh.positions = {{-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5}, {1, 0, -5}, {1, 0, 5}, {1, 3, 5}, {1, 3, -5}};
  room.mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  scene.mesh_colliders.push_back(room);
  scene.add(make_body({{Box{{0.05f, 0.05f, 0.05f}}}}, {.position = {0.8f, 0.052f, 0}, .mass = 1}));
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) EXPECT_TRUE(world.step(1.f / 60).ok());
  const std::vector<Vec3f> push{{speed, 0, 0}};
  world.object(0).set_velocities(push);
  float farthest = 0;
  for (int frame = 0; frame < 30; ++frame) {
    EXPECT_TRUE(world.step(1.f / 60).ok());
    farthest = std::max(farthest, world.object(0).positions()[0].x);
  }
  return farthest;
}

/// The triangles that it will meet are not those on which it lies.
TEST(FlatBody, ABoxAtRestThatIsPushedMeetsTheWallsOfItsRoom) {
  for (const float speed : {5.f, 10.f, 20.f, 30.f}) EXPECT_LT(farthest_after_a_push(speed), 0.955f) << speed;
}

}  // namespace
}  // namespace pliant
