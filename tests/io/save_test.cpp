// Tests saving: a loaded State or World continues with the same bits.
#include <gtest/gtest.h>

#include <limits>
#include <span>

#include "pliant/body.h"
#include "pliant/joint.h"
#include "pliant/save.h"
#include "pliant/stitch.h"
#include "save_support.h"
#include "support/scenes.h"
#include "write_support.h"

namespace pliant {
namespace {

using namespace testing_support;
using test::Folder;

constexpr float dt = 1.f / 60;

TEST(Save, AStateIsTheSameBitByBit) {
  const Folder folder;
  World world(full_scene());
  for (int frame = 0; frame < 3; ++frame) world.step(dt);
  save(folder / "state", world.state());
  EXPECT_EQ(hash(load_state(folder / "state")), world.state_hash());
  EXPECT_EQ(folder.names(), std::vector<std::string>{"state"});
  save(folder / "none", State{});
  EXPECT_EQ(hash(load_state(folder / "none")), hash(State{}));
}

TEST(Save, OrientationsGoOnInTheSameBits) {
  const Folder folder;
  Scene scene = full_scene();
  const float half = 0.70710678f;
  scene.objects[2].frames = {{{}, {1, 2, 3}, {1, 2, 4}}, {{half, 0, 0, half}, {0, -5, 0.1f}, {3, 1, 2}}};
  World world(scene);
  for (int frame = 0; frame < 3; ++frame) world.step(dt);
  const std::vector<Quatf> before = world.object(2).orientations();
  save(folder / "world", world, scene);
  LoadedWorld loaded = load_world(folder / "world");
  ASSERT_EQ(loaded.world.object(2).orientations().size(), 2U);
  for (int frame = 0; frame < 3; ++frame) {
    world.step(dt);
    loaded.world.step(dt);
  }
  EXPECT_EQ(loaded.world.state_hash(), world.state_hash());
  EXPECT_NE(world.object(2).orientations()[0].x, before[0].x) << "they turn";
}

TEST(Save, TargetsOfMotorsAreKept) {
  const Folder folder;
  Scene scene = full_scene();
  Object wheel = make_body({{Box{}}}, {.name = "wheel", .position = {50, 0, 0}});
  add_joint(wheel, HingeJoint{.b = 0, .anchor = {50, 0, 0}, .motor = JointMotor{.target = 1, .most = 1e4f}});
  const ObjectId id = scene.add(wheel);
  World world(scene);
  world.object(id).set_motor("hinge 0", {.target = -3, .most = 500});
  save(folder / "world", world, scene);
  LoadedWorld loaded = load_world(folder / "world");
  ASSERT_EQ(loaded.world.state().motors, world.state().motors);
  for (int frame = 0; frame < 3; ++frame) {
    world.step(dt);
    loaded.world.step(dt);
  }
  EXPECT_EQ(loaded.world.state_hash(), world.state_hash());
  EXPECT_LT(loaded.world.object(id).angular_velocities()[0].z, 0) << "as commanded, not as described";
}

TEST(Save, BodiesThatSleepGoOnSleeping) {
  const Folder folder;
  Scene scene;
  scene.settings.sleep = {true, 0.03f, 0.05f, 0.25f};
  scene.settings.integrator = Settings::Integrator::energy;
  scene.colliders.emplace_back();
  const ObjectId id = scene.add(make_body({{Box{}}}, {.name = "box", .position = {0, 0.5f, 0}}));
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  ASSERT_TRUE(world.object(id).body_is_asleep(0));
  save(folder / "world", world, scene);
  LoadedWorld loaded = load_world(folder / "world");
  EXPECT_EQ(loaded.scene.settings.sleep.time, 0.25f);
  EXPECT_EQ(loaded.scene.settings.integrator, Settings::Integrator::energy);
  EXPECT_EQ(loaded.world.state().rest_times, world.state().rest_times);
  EXPECT_EQ(loaded.world.step(dt).sleeping_bodies, 1);
  world.step(dt);
  EXPECT_EQ(loaded.world.state_hash(), world.state_hash());
  State other = world.state();
  other.rest_times = {};
  EXPECT_NE(hash(other), world.state_hash());
  other.rest_times = {-0.5f};
  EXPECT_NE(reason([&] { world.restore(other); }).find("time of rest"), std::string::npos);
  other.rest_times = {0, 0};
  EXPECT_NE(reason([&] { world.restore(other); }).find("2 frames"), std::string::npos);
}

TEST(Save, ChannelsAreKept) {
  const Folder folder;
  State state;
  state.channels = {{"temperature", 1, {20.5f, -0.f, 1e-40f}}, {"vorticity", 3, {1, 2, 3, 4, 5, 6, 7, 8, 9}}};
  save(folder / "state", state);
  const State loaded = load_state(folder / "state");
  EXPECT_EQ(hash(loaded), hash(state));
  EXPECT_NE(hash(loaded), hash(State{}));
  ASSERT_EQ(loaded.channels.size(), 2U);
  EXPECT_EQ(loaded.channels[1].name, "vorticity");
  EXPECT_EQ(loaded.channels[1].components, 3);
  EXPECT_EQ(loaded.channels[1].values[8], 9);
}

/// Threads that broke must not be whole again after a load.
TEST(Save, ASceneWhoseThreadsHaveBrokenIsRefused) {
  Object object;
  object.name = "thread";
  object.positions = {{0, 0, 0}, {0, -1, 0}};
  object.masses = {INFINITY, 1};
  const std::array<int, 2> pair{0, 1};
  add_stitches(object, std::span(&pair, 1), {.stiffness = Stiffness::compliance(1e-4f), .break_force = 1});
  object.constraints[0].keyframes = {{0, 1}};
  Scene scene;
  scene.add(object);
  World world(scene);
  for (int i = 0; i < 20; ++i) world.step(1.f / 60);
  const std::string path = testing::TempDir() + "broken.pliant";
  EXPECT_NE(reason([&] { save(path, world, scene); }).find("broken"), std::string::npos);
  scene.objects[0] = world.object(0).description();
  EXPECT_EQ(reason([&] { save(path, world, scene); }), "");
}

TEST(Save, AStateGoesOnInANewWorld) {
  const Folder folder;
  const Scene scene = full_scene();
  World world(scene);
  for (int frame = 0; frame < 8; ++frame) {
    save(folder / "state", world.state(), scene);
    World other(scene);
    other.restore(load_state(folder / "state", scene));
    for (int more = 0; more < 2; ++more) other.step(dt);
    world.step(dt);
    const State next = world.state();
    world.step(dt);
    ASSERT_EQ(other.state_hash(), world.state_hash()) << frame;
    world.restore(next);
  }
}

TEST(Save, AWorldGoesOnFromItsFileAlone) {
  const Folder folder;
  const Scene scene = full_scene();
  World world(scene);
  for (int frame = 0; frame < 4; ++frame) world.step(dt);
  save(folder / "world", world, scene);
  LoadedWorld loaded = load_world(folder / "world");
  EXPECT_EQ(loaded.world.state_hash(), world.state_hash());
  for (int frame = 0; frame < 6; ++frame) {
    world.step(dt);
    loaded.world.step(dt);
    ASSERT_EQ(loaded.world.state_hash(), world.state_hash()) << frame;
  }
  EXPECT_EQ(fingerprint(loaded.scene).scene, fingerprint(scene).scene);
  EXPECT_EQ(fingerprint(loaded.scene).settings, fingerprint(scene).settings);
  EXPECT_EQ(loaded.scene.frames, scene.frames);
  EXPECT_EQ(loaded.scene.objects[0].colour.z, 0.3f) << "also what decides no bits";
  EXPECT_TRUE(loaded.scene.settings.measure);
}

/// Also substeps that follow the State.
TEST(Save, AWorldGoesOnWithAnySweep) {
  const Folder folder;
  for (const NamedSweep& sweep : sweeps()) {
    Scene scene;
    const int cloth = scene.add_cloth(grid_mesh(20, 20, 1, 1));
    scene.pin(cloth, {0, 19});
    scene.objects[0].sweep = sweep.sweep;
    World world(scene);
    for (int frame = 0; frame < 3; ++frame) world.step(dt);
    save(folder / "world", world, scene);
    LoadedWorld loaded = load_world(folder / "world");
    for (int frame = 0; frame < 3; ++frame) {
      world.step(dt);
      loaded.world.step(dt);
    }
    EXPECT_EQ(loaded.world.state_hash(), world.state_hash()) << sweep.name;
  }
}

TEST(Save, AWorldOfWhichThingsCameAndWentGoesOnWithTheSameIds) {
  const Folder folder;
  Scene scene = full_scene();
  scene.settings.sweep = Sweep::automatic;
  World world(scene);
  world.step(dt);
  Collider extra = scene.colliders[0];
  extra.name = "extra";
  Object fringe = scene.objects[2], bell;
  fringe.name = "fringe";
  bell.name = "bell";
  bell.positions = {{0, 3, 0}, {0.1f, 3, 0}};
  bell.masses = {std::numeric_limits<float>::infinity(), 1};
  bell.frames = {ObjectFrame{{}, {0, 1, 0}, {1, 2, 3}}, ObjectFrame{{}, {3, 1, 0}, {1, 1, 1}}};
  const ColliderId ground = world.add(extra);
  world.remove(ObjectId(1));  // the balloon, whose block is larger than the one that takes its place
  const ObjectId gone = world.add(bell), first = world.add(fringe), second = world.add(bell);
  world.remove(gone);
  world.remove(ColliderId(0));
  world.remove(MeshColliderId(0));
  const RigidPose low{{0, -0.4f, 0}, {}};
  world.collider(ground).set_pose(low);
  world.step(dt);
  // The present contents by slot: the second bell took the slot of the first, which had been the balloon's.
  Scene now = scene;
  now.objects = {};
  for (const ObjectId id : world.objects()) {
    const std::string name = world.object(id).info().name;
    now.objects.push_back(name == "bell" ? bell : name == "fringe" ? fringe : scene.objects[name == "sheet" ? 0 : 2]);
  }
  now.colliders = {extra};
  now.mesh_colliders.erase(now.mesh_colliders.begin());
  save(folder / "world", world, now);
  LoadedWorld loaded = load_world(folder / "world");
  ASSERT_EQ(loaded.world.state_hash(), world.state_hash());
  EXPECT_EQ(loaded.world.objects(), world.objects());
  EXPECT_FALSE(loaded.world.has(gone));
  EXPECT_EQ(loaded.world.object(second).angular_velocities(), world.object(second).angular_velocities());
  for (int frame = 0; frame < 6; ++frame) {
    world.step(dt);
    loaded.world.step(dt);
    ASSERT_EQ(loaded.world.state_hash(), world.state_hash()) << frame;
    if (world.has(first)) {
      EXPECT_EQ(loaded.world.object(first).positions(), world.object(first).positions());
    }
    if (frame == 2)  // the next object takes the same slot
      for (World* each : {&world, &loaded.world}) each->add(scene.objects[1]);
    if (frame == 4)
      for (World* each : {&world, &loaded.world}) each->remove(first);
  }
  EXPECT_EQ(loaded.world.objects(), world.objects());
  EXPECT_NE(reason([&] { save(folder / "w", world, scene); }), "");
}

TEST(Save, AWorldKeepsTheSettingsThatItWasMadeWith) {
  const Folder folder;
  const Scene scene = full_scene();
  Settings settings = scene.settings;
  settings.substeps = 9;
  World world(scene, settings);
  world.step(dt);
  save(folder / "world", world, scene);
  LoadedWorld loaded = load_world(folder / "world");
  EXPECT_EQ(loaded.world.settings().substeps, 9);
  world.step(dt);
  loaded.world.step(dt);
  EXPECT_EQ(loaded.world.state_hash(), world.state_hash());
}

}  // namespace
}  // namespace pliant
