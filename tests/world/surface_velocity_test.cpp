// Tests surfaces that move along themselves while their shape stays, as belts and tracks do: friction drives what
// touches them.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/grains.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "support/refusal.h"
#include "support/run.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::refusal_of;
using testing_support::run;

constexpr float belt_friction = 0.4f;
constexpr double belt_mu = 0.4, belt_gravity = 9.81, belt_speed = 1;

Object parcel_at(const Vec3f& position) {
  Object box = make_body({{.shape = Box{{0.1f, 0.05f, 0.1f}}}}, {.name = "box", .position = position});
  box.static_friction = box.kinetic_friction = belt_friction;
  return box;
}

template <class Thing>
Thing rough(Thing thing) {
  thing.static_friction = thing.kinetic_friction = belt_friction;
  return thing;
}

Vec3f parcel_place(const World& world, int object = 0) { return world.object(object).positions()[0]; }
Vec3f parcel_velocity(const World& world, int object = 0) { return world.object(object).velocities()[0]; }

/// From rest friction accelerates by mu g until v / (mu g) = 0.255 s; then the box goes with the belt, v^2 / (2 mu g) =
/// 0.127 m behind it.
void expect_on_belt(World& world, double tolerance = 0.01) {
  run(world, 6);
  EXPECT_NEAR(parcel_velocity(world).x, belt_mu * belt_gravity * 0.1, 0.02);
  run(world, 54);
  EXPECT_NEAR(parcel_velocity(world).x, belt_speed, 1e-3);
  EXPECT_NEAR(parcel_place(world).x, belt_speed * 1 - belt_speed * belt_speed / (2 * belt_mu * belt_gravity),
              tolerance);
  EXPECT_NEAR(parcel_place(world).z, 0, 1e-3);
}

TEST(SurfaceVelocity, OfAColliderTakesABoxAlong) {
  Scene scene;
  scene.add(parcel_at({0, 0.05f, 0}));
  Collider belt;
  belt.surface_velocity = {1, 0, 0};
  scene.add(rough(belt));
  World world(scene);
  expect_on_belt(world);
}

/// It is in the collider's own frame, which is turned here: its -z axis points along x.
TEST(SurfaceVelocity, IsInTheFrameOfTheCollider) {
  Scene scene;
  scene.add(parcel_at({0, 0.05f, 0}));
  Collider belt;
  belt.shape = Box{{3, 0.1f, 3}};
  belt.position = {0, -0.1f, 0};
  belt.rotation = rotation({0, 1, 0}, -90);
  belt.surface_velocity = {0, 0, -1};
  scene.add(rough(belt));
  World world(scene);
  expect_on_belt(world);
}

TEST(SurfaceVelocity, OfAMeshTakesABoxAlong) {
  Scene scene;
  scene.add(parcel_at({0, 0.05f, 0}));
  MeshCollider belt;
  belt.mesh = grid_mesh(9, 9, 6, 6);
  belt.surface_velocity = {1, 0, 0};
  scene.add(rough(belt));
  World world(scene);
  expect_on_belt(world);
}

TEST(SurfaceVelocity, OfAMeshThatDeformsAddsToThatOfItsVertices) {
  Scene scene;
  scene.add(parcel_at({0, 0.05f, 0}));
  MeshCollider belt;
  belt.mesh = grid_mesh(2, 2, 6, 6);
  belt.frames = {{0, belt.mesh.positions}, {2, belt.mesh.positions}};
  for (Vec3f& p : belt.frames[1].positions) p.x += 1;
  belt.surface_velocity = {0.5f, 0, 0};
  scene.add(rough(belt));
  World world(scene);
  expect_on_belt(world);
}

TEST(SurfaceVelocity, OfAKinematicBodyTakesABoxAlong) {
  Scene scene;
  scene.add(parcel_at({0, 0.05f, 0}));
  BodyOptions options;
  options.position = {0, -0.1f, 0};
  options.rotation = rotation({0, 1, 0}, 180);
  options.kinematic = true;
  options.surface_velocity = {-1, 0, 0};
  scene.add(rough(make_body({{.shape = Box{{3, 0.1f, 2}}}}, options)));
  World world(scene);
  expect_on_belt(world);
}

/// Tracks that push the ground backwards drive their vehicle.
TEST(SurfaceVelocity, OfABodyDrivesItOverTheGround) {
  Scene scene;
  Object vehicle = parcel_at({0, 0.05f, 0});
  vehicle.bodies[0].surface_velocity = {-1, 0, 0};
  scene.add(vehicle);
  scene.add(rough(Collider{}));
  World world(scene);
  expect_on_belt(world);
}

/// A box on a belt that floats: friction is between the two, so momentum stays zero, and they part with the speed of
/// the belt.
TEST(SurfaceVelocity, BetweenTwoFreeBodiesKeepsMomentum) {
  Scene scene;
  Object belt = rough(make_body({{.shape = Box{{3, 0.1f, 2}}, .density = 10}}, {.position = {0, -0.1f, 0}}));
  belt.bodies[0].surface_velocity = {1, 0, 0};
  scene.add(parcel_at({0, 0.05f, 0}));
  scene.add(belt);
  Collider ice;
  ice.position = {0, -0.2f, 0};
  ice.static_friction = ice.kinetic_friction = 0;
  scene.add(ice);
  World world(scene);
  run(world, 60);
  const double box = scene.objects[0].masses[0], below = scene.objects[1].masses[0];
  EXPECT_NEAR(parcel_velocity(world).x - parcel_velocity(world, 1).x, 1, 5e-3);
  EXPECT_NEAR(box * parcel_velocity(world).x + below * parcel_velocity(world, 1).x, 0, 1e-3 * box);
}

/// What is along the normal neither lifts nor presses.
TEST(SurfaceVelocity, HasNoEffectAlongTheNormal) {
  Scene scene;
  scene.add(parcel_at({0, 0.05f, 0}));
  Collider belt;
  belt.surface_velocity = {0, 5, 0};
  scene.add(rough(belt));
  World world(scene);
  run(world, 30);
  EXPECT_NEAR(parcel_place(world).y, 0.05, 1e-3);
  EXPECT_NEAR(parcel_velocity(world).x, 0, 1e-4);
}

/// Cloth, and a grain, on belts of each kind.
void expect_particles_on_belt(Scene scene, bool with_grain) {
  TriangleMesh sheet = grid_mesh(4, 4, 0.3f, 0.3f);
  for (Vec3f& p : sheet.positions) p.y = 0.001f;
  Object cloth = rough(make_cloth(sheet));
  cloth.collides = true;
  const int of_cloth = scene.add(cloth);
  if (with_grain) scene.add(make_grains({{0, 0.02f, 1}}, {.grains = {.radius = 0.02f}}));
  World world(scene);
  run(world, 30);
  const double behind = belt_speed * belt_speed / (2 * belt_mu * belt_gravity);
  for (std::size_t i = 0; i < sheet.positions.size(); ++i)
    EXPECT_NEAR(world.object(of_cloth).positions()[i].x - sheet.positions[i].x, 0.5 - behind, 0.02) << i;
  EXPECT_NEAR(parcel_velocity(world, of_cloth).x, 1, 0.01);
  if (!with_grain) return;
  EXPECT_NEAR(parcel_velocity(world, of_cloth + 1).x, 1, 0.01);
}

TEST(SurfaceVelocity, OfAColliderTakesClothAndGrainsAlong) {
  Scene scene;
  Collider belt;
  belt.surface_velocity = {1, 0, 0};
  scene.add(rough(belt));
  expect_particles_on_belt(scene, true);
}

TEST(SurfaceVelocity, OfAMeshTakesClothAlong) {
  Scene scene;
  MeshCollider belt;
  belt.mesh = grid_mesh(9, 9, 6, 6);
  belt.surface_velocity = {1, 0, 0};
  scene.add(rough(belt));
  expect_particles_on_belt(scene, false);
}

TEST(SurfaceVelocity, OfABodyTakesClothAndGrainsAlong) {
  Scene scene;
  BodyOptions options;
  options.position = {0, -0.1f, 0};
  options.kinematic = true;
  options.surface_velocity = {1, 0, 0};
  scene.add(rough(make_body({{.shape = Box{{3, 0.1f, 2}}}}, options)));
  expect_particles_on_belt(scene, true);
}

/// A box that a wall holds on a belt is slow, but the belt acts on it.
TEST(SurfaceVelocity, LetsNothingSleepOnIt) {
  Scene scene;
  scene.settings.sleep.on = true;
  scene.add(parcel_at({0, 0.05f, 0}));
  Collider belt;
  belt.surface_velocity = {1, 0, 0};
  scene.add(rough(belt));
  Collider wall;
  wall.shape = Box{{0.1f, 0.5f, 1}};
  wall.position = {0.2f, 0.5f, 0};
  scene.add(wall);
  World world(scene);
  run(world, 90);
  EXPECT_FALSE(world.object(0).body_is_asleep(0));
}

/// Belts that are set do what belts do that are described so.
TEST(SurfaceVelocity, MayBeSetBetweenSteps) {
  Scene scene;
  scene.add(parcel_at({0, 0.05f, 0}));
  scene.add(parcel_at({0, 0.05f, 5}));
  scene.add(parcel_at({0, 0.05f, 10}));
  Collider belt;
  belt.shape = Box{{3, 0.1f, 2}};
  belt.position = {0, -0.1f, 0};
  belt.surface_velocity = {0, 0, 3};
  const int collider = scene.add(rough(belt));
  MeshCollider mesh;
  mesh.mesh = grid_mesh(9, 9, 6, 4);
  for (Vec3f& p : mesh.mesh.positions) p.z += 5;
  const int net = scene.add(rough(mesh));
  BodyOptions options;
  options.name = "belt";
  options.position = {0, -0.1f, 10};
  options.rotation = rotation({0, 1, 0}, 180);
  options.kinematic = true;
  scene.add(rough(make_body({{.shape = Box{{3, 0.1f, 2}}}}, options)));
  World world(scene);
  world.collider(collider).set_surface_velocity({1, 0, 0});
  world.mesh_collider(net).set_surface_velocity({1, 0, 0});
  world.object(3).set_surface_velocity("belt", {-1, 0, 0});
  run(world, 60);
  for (const int box : {0, 1, 2}) {
    EXPECT_NEAR(parcel_velocity(world, box).x, 1, 1e-3) << box;
    EXPECT_NEAR(parcel_place(world, box).x, 1 - 1 / (2 * belt_mu * belt_gravity), 0.01) << box;
  }
  World resumed(scene);
  resumed.restore(world.state());
  world.collider(collider).set_surface_velocity({});
  resumed.collider(collider).set_surface_velocity({});
  run(world, 30);
  run(resumed, 30);
  EXPECT_EQ(world.state_hash(), resumed.state_hash());
  EXPECT_NEAR(parcel_velocity(world).x, 0, 1e-3) << "its belt stands";
  EXPECT_NEAR(parcel_velocity(world, 1).x, 1, 1e-3) << "the others run on";
}

TEST(SurfaceVelocity, WakesWhatSleepsWhenItIsSet) {
  Scene scene;
  scene.settings.sleep.on = true;
  scene.settings.sleep.time = 0.1f;
  scene.add(parcel_at({0, 0.05f, 0}));
  scene.add(parcel_at({0, 0.05f, 5}));
  Collider belt;
  belt.shape = Box{{3, 0.1f, 2}};
  belt.position = {0, -0.1f, 0};
  const int collider = scene.add(rough(belt));
  scene.add(rough(make_body({{.shape = Box{{3, 0.1f, 2}}}}, {.position = {0, -0.1f, 5}, .kinematic = true})));
  World world(scene);
  run(world, 30);
  ASSERT_TRUE(world.object(0).body_is_asleep(0));
  ASSERT_TRUE(world.object(1).body_is_asleep(0));
  world.collider(collider).set_surface_velocity({1, 0, 0});
  world.object(2).set_surface_velocity(0, {1, 0, 0});
  run(world, 30);
  EXPECT_NEAR(parcel_velocity(world).x, 1, 1e-2);
  EXPECT_NEAR(parcel_velocity(world, 1).x, 1, 1e-2);
}

TEST(SurfaceVelocity, IsRefusedWhereItCannotBeSet) {
  Scene scene;
  Object box = parcel_at({0, 0.05f, 0});
  box.name = "parcel";
  scene.add(box);
  const int collider = scene.add(Collider{});
  World world(scene);
  const auto said = [](const auto& call) { return testing_support::refusal(call); };
  EXPECT_NE(said([&] { world.object(0).set_surface_velocity(1, {}); }).find("object 'parcel', body 1: does not exist"),
            std::string::npos);
  EXPECT_NE(said([&] {
              world.object(0).set_surface_velocity(0, {NAN, 0, 0});
            }).find("is not finite"),
            std::string::npos);
  EXPECT_NE(said([&] {
              world.collider(collider).set_surface_velocity({1e7f, 0, 0});
            }).find("above 1e6 m/s"),
            std::string::npos);
  State state = world.state();
  state.surface_velocities.push_back({SurfaceVelocity::Of::body, 0, 0, 3, {}});
  EXPECT_NE(said([&] { world.restore(state); }).find("surface velocity 0: is of nothing in this World"),
            std::string::npos);
}

TEST(SurfaceVelocity, MustBeFinite) {
  Scene scene;
  scene.add(parcel_at({0, 0.05f, 0}));
  Collider belt;
  belt.name = "belt";
  belt.surface_velocity = {NAN, 0, 0};
  scene.add(belt);
  EXPECT_NE(refusal_of(scene).find("'belt', surface_velocity"), std::string::npos) << refusal_of(scene);
  scene.colliders.clear();
  scene.objects[0].bodies[0].surface_velocity = {0, 1e7f, 0};
  EXPECT_NE(refusal_of(scene).find("body 0 'box', surface_velocity"), std::string::npos) << refusal_of(scene);
}

}  // namespace
}  // namespace pliant
