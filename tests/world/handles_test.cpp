// Tests the handles of what is in a World.
#include <gtest/gtest.h>

#include <type_traits>
#include <utility>

#include "pliant/error.h"
#include "world/run_time_support.h"

namespace pliant {
namespace {

using namespace testing_support;

static_assert(std::is_same_v<decltype(std::declval<const World&>().object(0)), ObjectView>,
              "a const World is not changed");
static_assert(std::is_same_v<decltype(std::declval<World&>().object(0)), ObjectHandle>);
static_assert(std::is_same_v<decltype(std::declval<const World&>().collider(0)), ColliderView>);
static_assert(std::is_same_v<decltype(std::declval<const World&>().mesh_collider(0)), MeshColliderView>);

Scene sheet_and_colliders() {
  Scene scene;
  scene.settings = settings_of(4);
  scene.add(sheet_at("sheet", {0, 1, 0}, 5, 0.5f));
  scene.add(Collider{.name = "ball", .shape = Sphere{0.1f}, .position = {3, 0, 0}});
  MeshCollider box;
  box.mesh = box_mesh({1, 1, 1});
  scene.mesh_colliders.push_back(box);
  return scene;
}

TEST(Handles, FollowAWorldThatIsMoved) {
  const Scene scene = sheet_and_colliders();
  World world(scene);
  ObjectHandle sheet = world.object(0);
  const ColliderHandle ball = world.collider(0);
  World moved = std::move(world);
  sheet.set_velocities(std::vector<Vec3f>(25, Vec3f{1, 0, 0}));
  EXPECT_EQ(moved.object(0).velocities()[7], (Vec3f{1, 0, 0}));
  EXPECT_EQ(sheet.positions(), scene.objects[0].positions);
  EXPECT_EQ(ball.pose().position, (Vec3f{3, 0, 0}));
  moved.step(dt);
  EXPECT_NEAR(sheet.positions()[7].x, scene.objects[0].positions[7].x + dt, 1e-4f);
}

TEST(Handles, OfWhatWasRemovedThrowAndNeverReachWhatTookItsPlace) {
  const Scene scene = sheet_and_colliders();
  World world(scene);
  ObjectHandle sheet = world.object(0);
  ColliderHandle ball = world.collider(0);
  MeshColliderHandle box = world.mesh_collider(0);
  world.remove(ObjectId(0));
  world.remove(ColliderId(0));
  world.remove(MeshColliderId(0));
  world.add(scene.objects[0]);
  world.add(scene.colliders[0]);
  world.add(scene.mesh_colliders[0]);
  const std::string before = world.state_hash();
  EXPECT_THROW(sheet.positions(), Error);
  EXPECT_THROW(sheet.info(), Error);
  EXPECT_THROW(sheet.set_velocities(std::vector<Vec3f>(25)), Error);
  EXPECT_THROW(ball.pose(), Error);
  EXPECT_THROW(ball.set_pose({}), Error);
  EXPECT_THROW(box.positions(), Error);
  EXPECT_THROW(box.set_pose({}), Error);
  EXPECT_THROW(box.set_positions(scene.mesh_colliders[0].mesh.positions), Error);
  EXPECT_EQ(world.state_hash(), before);
}

TEST(Handles, ReadWhatTheyWereMadeFor) {
  Scene scene = sheet_and_colliders();
  scene.add(sheet_at("other", {5, 2, 0}, 4, 0.3f));
  World world(scene);
  for (const ObjectId id : world.objects()) {
    const auto object = world.object(id);
    EXPECT_EQ(object.id(), id);
    EXPECT_EQ(object.info().name, scene.objects[static_cast<std::size_t>(id.slot)].name);
    EXPECT_EQ(object.positions(), scene.objects[static_cast<std::size_t>(id.slot)].positions);
    std::vector<Vec3f> read(object.positions().size());
    object.read_positions(read);
    EXPECT_EQ(read, object.positions());
  }
  std::vector<Vec3f> corners(8);
  world.mesh_collider(0).read_positions(corners);
  EXPECT_EQ(corners, scene.mesh_colliders[0].mesh.positions);
}

}  // namespace
}  // namespace pliant
