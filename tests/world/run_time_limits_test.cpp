// Tests the limits of a World to which objects are added at run time.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pliant/error.h"
#include "world/run_time_support.h"

namespace pliant {
namespace {

using namespace testing_support;

Object small_sheet(const Vec3f& at, int n = 5) {
  TriangleMesh mesh = grid_mesh(n, n, 0.4f, 0.4f);
  for (Vec3f& p : mesh.positions) p += at;
  Object object = make_cloth(mesh);
  object.collides = true;
  return object;
}

MeshCollider block() {
  MeshCollider collider;
  collider.mesh = box_mesh({1, 0.2f, 1});
  return collider;
}

template <class Act>
void expect_refused(World& world, const Act& act) {
  const std::string before = world.state_hash();
  EXPECT_THROW(act(), Error);
  EXPECT_EQ(world.state_hash(), before);
}

TEST(RunTimeLimits, AHoleBelongsToNoBody) {
  Scene scene;
  scene.gravity = {};
  scene.settings = settings_of(4);
  scene.settings.initial_intersections = Settings::Intersections::untangle;
  Scene made_at_once = scene;
  scene.add(small_sheet({5, 0, 0}, 2));
  scene.add(small_sheet({}));
  World world(scene);
  world.remove(ObjectId(0));
  world.add(block());  // gets the number of the removed object, but does not fit into its block
  made_at_once.add(small_sheet({}));
  made_at_once.add(block());
  World other(made_at_once);
  const Report found = world.step(dt), expected = other.step(dt);
  EXPECT_GT(expected.pairs.inside, 0);
  EXPECT_EQ(found.pairs.inside, expected.pairs.inside);
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  EXPECT_EQ(world.step(dt).pairs.inside, 0);
}

TEST(RunTimeLimits, NoObjectTakesASweepThatDoesNotSuitTheAcceleration) {
  Scene scene;
  scene.settings = settings_of(4, 10);
  scene.settings.sweep_options.acceleration = SweepOptions::Acceleration::chebyshev;
  const ObjectId there = scene.add(small_sheet({}));
  World world(scene);
  Object natural = small_sheet({1, 0, 0});
  natural.sweep = Sweep::natural;
  expect_refused(world, [&] { world.add(natural); });
  Edit edit = unchanged(small_sheet({}));
  edit.object.sweep = Sweep::natural;
  expect_refused(world, [&] { world.edit(there, edit); });
  EXPECT_EQ(world.object_count(), 1);
  edit.object.sweep = Sweep::symmetric;
  EXPECT_NO_THROW(world.edit(there, edit));
}

TEST(RunTimeLimits, ThingsThatBeganInOnePlaceOneAfterAnotherAreLaidOutAgain) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.settings.initial_intersections = Settings::Intersections::refuse;
  scene.add(small_sheet({}));
  World world(scene);
  for (int frame = 0; frame < 20; ++frame) world.step(dt);  // the object falls
  Object next = small_sheet({});
  const Vec3f middle = (next.positions.front() + next.positions.back()) * 0.5f;
  for (Vec3f& p : next.positions)  // across the place where the first object began
    p = middle + Vec3f{p.x - middle.x + 0.03f, p.z - middle.z + 0.02f, p.y - middle.y + 0.01f};
  ASSERT_NO_THROW(world.add(next));
  scene.add(next);
  World again(scene, world.layout());
  again.restore(world.state());
  for (int frame = 0; frame < 5; ++frame) {
    world.step(dt);
    again.step(dt);
  }
  EXPECT_EQ(world.state_hash(), again.state_hash());
}

TEST(RunTimeLimits, AStateWhoseChannelsDoNotFitIsRefused) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.add(small_sheet({}));
  World world(scene);
  State state = world.state();
  state.channels = {{"heat", 2, std::vector<float>(2 * state.positions.size(), 1.f)}};
  EXPECT_NO_THROW(world.restore(state));
  state.channels[0].values.pop_back();
  expect_refused(world, [&] { world.restore(state); });
  state.channels[0].components = 0;
  expect_refused(world, [&] { world.restore(state); });
  state.channels[0] = {"heat", 1, {}};
  expect_refused(world, [&] { world.restore(state); });
}

TEST(RunTimeLimits, APoseFarAwayComesBackWithItsState) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.add(small_sheet({}));
  const ColliderId ball = scene.add(Collider{.name = "ball", .shape = Sphere{0.1f}});
  World world(scene);
  world.collider(ball).set_pose({{1e20f, 0, 0}, {}});
  world.step(dt);
  const State state = world.state();
  EXPECT_NO_THROW(world.restore(state));
}

TEST(RunTimeLimits, AnImpulseThatNoVelocityHoldsIsRefused) {
  Scene scene;
  scene.settings = settings_of(4);
  const ObjectId object = scene.add(small_sheet({}));
  World world(scene);
  std::vector<Vec3f> impulses(world.object(object).positions().size());
  impulses[3] = {1e38f, 0, 0};
  expect_refused(world, [&] { world.object(object).add_impulses(impulses); });
  EXPECT_TRUE(is_finite(world.state()));
}

TEST(RunTimeLimits, ALayoutBeyondAllNumbersIsRefused) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.add(small_sheet({}));
  const World world(scene);
  const int most = std::numeric_limits<int>::max();
  WorldLayout layout = world.layout();
  layout.blocks[0].first = most - 1;
  EXPECT_THROW(World(scene, layout), Error);
  layout = world.layout();
  layout.first_frames[0] = most;
  EXPECT_THROW(World(scene, layout), Error);
  layout = world.layout();
  layout.objects[0].generation = most;
  EXPECT_THROW(World(scene, layout), Error);
}

}  // namespace
}  // namespace pliant
