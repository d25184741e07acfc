// Tests saving a World whose kinematic bodies were given poses, and whose surfaces were given velocities, while it ran:
// loaded from a file it goes on with the same bits.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/save.h"
#include "pliant/world.h"
#include "support/run.h"
#include "write_support.h"

namespace pliant {
namespace {

using test::Folder;
using testing_support::run;

constexpr Box crate_of_the_lift{{0.1f, 0.1f, 0.1f}};

template <class Thing>
Thing gripping(Thing thing) {
  thing.static_friction = thing.kinetic_friction = 0.8f;
  return thing;
}

/// A kinematic platform with a crate on it.
Object platform_with_crate(const std::string& name, const Vec3f& position, const Motion& motion = {}) {
  Object lift = make_body({{.shape = Box{{0.5f, 0.05f, 0.5f}}}},
                          {.name = "platform", .position = position, .kinematic = true, .motion = motion});
  add_body(lift, {{.shape = crate_of_the_lift}}, {.name = "crate", .position = position + Vec3f{0.2f, 0.15f, 0}});
  lift.name = name;
  return gripping(lift);
}

Object crate_at(const std::string& name, const Vec3f& position) {
  Object crate = make_body({{.shape = crate_of_the_lift}}, {.position = position});
  crate.name = name;
  return gripping(crate);
}

/// A platform that is set, one with keyframes, and belts that are a collider, a mesh and a kinematic body.
Scene lifts_and_belts() {
  Scene scene;
  scene.settings.threads = 1;
  scene.add(platform_with_crate("lift", {}));
  scene.add(platform_with_crate("keyframes", {3, 0, 0}, {{{0}, {1, {0, 0.5f, 0.2f}}}}));
  scene.add(gripping(
      make_body({{.shape = Box{{2, 0.1f, 1}}}}, {.name = "belt", .position = {0, -0.1f, 5}, .kinematic = true})));
  Collider belt;
  belt.name = "belt";
  belt.shape = Box{{2, 0.1f, 1}};
  belt.position = {0, -0.1f, 10};
  scene.add(gripping(belt));
  MeshCollider net;
  net.name = "net";
  net.mesh = grid_mesh(5, 5, 4, 2);
  for (Vec3f& p : net.mesh.positions) p.z += 15;
  scene.add(gripping(net));
  for (const int z : {5, 10, 15}) scene.add(crate_at("crate " + std::to_string(z), {0, 0.1f, static_cast<float>(z)}));
  return scene;
}

/// What a program sets before a frame.
void set_for(World& world, int frame) {
  const auto at = static_cast<float>(frame);
  world.object(0).set_pose("platform", {{0, 0.01f * at, 0}, rotation({0, 1, 0}, at)});
  if (frame != 1) return;
  world.object(2).set_surface_velocity("belt", {1, 0, 0});
  world.collider(0).set_surface_velocity({0.5f, 0, 0});
  world.mesh_collider(0).set_surface_velocity({-1, 0, 0});
}

/// Saved after a frame in which a pose was set, so the platform has moved. A pose that is set after the step, as forces
/// that are, is no part of a State: it is set again after loading.
TEST(SaveKinematic, AWorldWithPosesAndSurfaceVelocitiesGoesOnWithTheSameBits) {
  const Folder folder;
  const Scene scene = lifts_and_belts();
  World world(scene);
  for (int frame = 1; frame <= 20; ++frame) {
    set_for(world, frame);
    run(world, 1);
  }
  save(folder / "world", world, scene);
  save(folder / "state", world.state(), scene);
  LoadedWorld loaded = load_world(folder / "world");
  World restored(scene);
  restored.restore(load_state(folder / "state", scene));
  for (World* one : {&world, &loaded.world, &restored}) {
    run(*one, 5);  // nothing is set: platforms stay, belts run on
    for (int frame = 21; frame <= 30; ++frame) {
      one->object(0).set_pose("platform", {{0, 0.01f * static_cast<float>(frame), 0}, {}});
      run(*one, 1);
    }
  }
  EXPECT_EQ(loaded.world.state_hash(), world.state_hash());
  EXPECT_EQ(restored.state_hash(), world.state_hash());
  EXPECT_NEAR(loaded.world.object(0).pose("crate").position.y, 0.3 + 0.15, 0.01) << "it is carried";
  EXPECT_NEAR(loaded.world.object(1).pose("platform").position.y, 0.5 * 35 / 60, 1e-3);
  EXPECT_NEAR(loaded.world.object(3).velocities()[0].x, 1, 0.01);
  EXPECT_NEAR(loaded.world.object(4).velocities()[0].x, 0.5, 0.01);
  EXPECT_NEAR(loaded.world.object(5).velocities()[0].x, -1, 0.01);
}

}  // namespace
}  // namespace pliant
