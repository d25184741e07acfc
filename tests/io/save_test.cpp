// Tests saving: a loaded State or World continues with the same bits, and anything but a complete file of this format
// is rejected with the reason.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <limits>
#include <random>
#include <span>

#include "core/sha256.h"
#include "io/save_file.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/joint.h"
#include "pliant/save.h"
#include "pliant/stitch.h"
#include "support/scenes.h"
#include "write_support.h"

namespace pliant {
namespace {

using test::Folder;

constexpr float dt = 1.f / 60;

/// A scene with a value in every member that a file contains.
Scene full_scene() {
  Scene scene;
  scene.gravity = {0.5f, -9, 0.25f};
  scene.wind = {{1, 0, 2}, 0.5f, 3, 1.2f};
  ClothOptions options;
  options.name = "sheet";
  options.velocity = {0, -1, 0};
  const int sheet = scene.add_cloth(grid_mesh(9, 9, 1, 1), options);
  scene.objects[sheet].self_collision = scene.objects[sheet].collides = true;
  scene.objects[sheet].colour = {0.1f, 0.2f, 0.3f};
  scene.pin(sheet, {0}, testing_support::straight({0.1f, 0, 0}, 1));
  scene.objects[sheet].attachments.push_back({8, {0.5f, 0.2f, -0.5f}, {}, Stiffness::compliance(1e-4f, 0.1f)});
  options.name = "balloon";
  options.volume = Volume{1.5f, Stiffness::compliance(1e-3f)};
  const int balloon = scene.add_cloth(sphere_mesh(1), options);
  scene.objects[balloon].collides = true;
  for (Vec3f& x : scene.objects[balloon].positions) x = x * 0.2f + Vec3f{0, 0.3f, 0};
  Object rope = make_rope({{2, 0, 0}, {2.1f, 0, 0}, {2.2f, 0, 0}});
  rope.masses[0] = std::numeric_limits<float>::infinity();
  scene.add(rope);
  Collider capsule;
  capsule.name = "capsule";
  capsule.shape = Capsule{0.1f, 0.3f};
  capsule.position = {0, -0.3f, 0};
  capsule.motion = {{Keyframe{0, {}, {}}, Keyframe{0.5f, {0.1f, 0, 0}, rotation({0, 0, 1}, 40)}}, {0, 1, 0}, true};
  scene.add(capsule);
  MeshCollider ball;
  ball.name = "ball";
  ball.mesh = sphere_mesh(2);
  for (Vec3f& x : ball.mesh.positions) x = x * 0.2f + Vec3f{0.3f, -0.3f, 0.2f};
  scene.add(ball);
  ball.name = "grid";
  for (Vec3f& x : ball.mesh.positions) x.x -= 0.7f;
  ball.as = MeshCollider::As::distance_grid;
  ball.field = measure_distances(ball.mesh, 0.05f);
  scene.add(ball);
  scene.pairs.push_back({"sheet", "balloon", 0.01f, std::nullopt, 0.1f, std::nullopt});
  scene.settings.substeps = 5;
  scene.settings.sweep_options.relaxation = 1.1f;
  scene.settings.measure = true;
  return scene;
}

std::string reason(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string hash_of_file(const std::string& bytes) {
  Sha256 sha;
  sha.add(bytes.data(), bytes.size());
  const std::string text = sha.finish();
  std::string digest;
  for (std::size_t i = 0; i < text.size(); i += 2)
    digest += static_cast<char>(std::stoi(text.substr(i, 2), nullptr, 16));
  return digest;
}

/// The bytes with a correct checksum: a forged file, not a damaged one.
std::string sealed(std::string bytes) {
  bytes.resize(bytes.size() - 32);
  return bytes + hash_of_file(bytes);
}

// ------------------------------------------------------------------------------------------------ the same bits

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

// ------------------------------------------------------------------------------------------------ refusals

TEST(Save, EveryCutAndEveryFlippedBitIsRefused) {
  const Folder folder;
  const std::string path = folder / "state";
  State state;
  state.positions = state.remainders = state.velocities = Records(2);
  save(path, state);
  const std::string whole = test::read(path);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    test::put(path, whole.substr(0, size));
    const std::string why = reason([&] { load_state(path); });
    ASSERT_EQ(why.rfind(path + ": is ", 0), 0u) << size << " " << why;
  }
  test::put(path, whole + "x");
  EXPECT_NE(reason([&] { load_state(path); }).find("header says"), std::string::npos);
  std::vector<std::byte> bytes = save_bytes(state);  // as in the file
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= std::byte(1 << (bit % 8));
    ASSERT_EQ(reason([&] { load_state_bytes(bytes, "it"); }).rfind("it: ", 0), 0u) << "bit " << bit;
    bytes[bit / 8] ^= std::byte(1 << (bit % 8));
  }
}

TEST(Save, TheReasonIsNamed) {
  const Folder folder;
  const std::string path = folder / "state";
  const auto why = [&](const std::string& bytes) {
    test::put(path, bytes);
    return reason([&] { load_state(path); });
  };
  const auto says = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  save(path, State{});
  const std::string whole = test::read(path);
  std::string changed = whole;
  changed[8] = 2;
  says(why(changed), "has format version 2, and this Pliant reads version 24; use the Pliant that wrote it");
  says(why(""), "is empty");
  says(why("o cloth\nv 0 0 0\n"), "is not a file saved by Pliant");
  says(why(whole.substr(0, 100)),
       "is incomplete or damaged: its header says " + std::to_string(whole.size()) + " bytes, it has 100");
  changed = whole;
  changed[60] ^= 1;
  says(why(changed), "is damaged: its checksum");
  const Scene scene = full_scene();
  const World world(scene);
  save(path, world, scene);
  says(reason([&] { load_state(path); }), "holds a World, not a State; load it as a World");
  save(path, State{});
  says(reason([&] { load_world(path); }), "holds a State, not a World");
  says(reason([&] { load_state(folder.path()); }), "is a folder");
  says(reason([&] { load_state(folder / "missing"); }), "cannot open");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  says(reason([&] { load_state(folder / "pipe"); }), "is a pipe");
}

/// With a correct checksum, so that only the sizes themselves can be found wrong.
TEST(Save, ForgedSizesAreRefusedBeforeMemoryIsTaken) {
  const Folder folder;
  const std::string path = folder / "state";
  save(path, State{});
  const std::string whole = test::read(path);
  const std::size_t count_of_blocks = 24, first_block = 32, element_size = first_block + 28, count = first_block + 32;
  for (const std::uint64_t huge :
       {std::uint64_t{2}, std::uint64_t{1} << 31, std::uint64_t{1} << 61, ~std::uint64_t{0}}) {
    for (const std::size_t at : {count_of_blocks, count}) {
      std::string forged = whole;
      forged.replace(at, 8, reinterpret_cast<const char*>(&huge), 8);
      test::put(path, sealed(forged));
      ASSERT_NE(reason([&] { load_state(path); }).find("is malformed"), std::string::npos) << at << " " << huge;
    }
  }
  for (const std::uint32_t size : {0u, 16u, ~0u}) {
    std::string forged = whole;
    forged.replace(element_size, 4, reinterpret_cast<const char*>(&size), 4);
    test::put(path, sealed(forged));
    ASSERT_NE(reason([&] { load_state(path); }).find("is malformed"), std::string::npos) << size;
  }
  std::string renamed = whole;
  renamed[first_block] = 'S';
  test::put(path, sealed(renamed));
  EXPECT_NE(reason([&] { load_state(path); }).find("block 'State.time', which this Pliant does not know"),
            std::string::npos);
}

/// Thousands of forged files of a World, each with a correct checksum: an Error or a World, never a crash or
/// bad_alloc.
TEST(Save, AForgedWorldIsRefusedOrLoaded) {
  const Folder folder;
  const std::string path = folder / "world";
  Scene scene;
  scene.add(testing_support::chain(3, 0.1f));
  Collider ball;
  ball.shape = Sphere{0.1f};
  scene.add(ball);
  save(path, World(scene), scene);
  const std::string whole = test::read(path);
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string forged = whole;
    for (int k = 1 + static_cast<int>(random() % 3); k > 0; --k)
      forged[24 + random() % (forged.size() - 56)] = static_cast<char>(i % 2 == 0 ? random() : 255);
    const std::string bytes = sealed(forged);
    refused += reason([&] { load_world_bytes(std::as_bytes(std::span(bytes))); }).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 500);
  EXPECT_LT(refused, 2000) << "a colour may be anything";
}

TEST(Save, AnotherSceneIsRefusedAndThisOneIsNotForItsColours) {
  const Folder folder;
  const std::string path = folder / "state";
  const Scene scene = full_scene();
  save(path, World(scene).state(), scene);
  const auto with = [&](const auto& change) {
    Scene other = scene;
    change(other);
    return reason([&] { load_state(path, other); });
  };
  const auto is_another = [&](const auto& change) {
    return with(change).find("was saved with another scene") != std::string::npos;
  };
  const auto has_other_settings = [&](const auto& change) {
    return with(change).find("was saved with other settings") != std::string::npos;
  };
  EXPECT_EQ(with([](Scene&) {}), "");
  EXPECT_EQ(with([](Scene& s) { s.objects[0].colour.x = 1; }), "");
  EXPECT_EQ(with([](Scene& s) { s.frames = 7; }), "");
  EXPECT_EQ(with([](Scene& s) { s.settings.threads = 2; }), "");
  EXPECT_EQ(with([](Scene& s) { s.settings.isa = "x86-64-v2"; }), "");
  EXPECT_EQ(with([](Scene& s) { s.mesh_colliders[1].field = nullptr; }), "") << "it is measured again";
  EXPECT_TRUE(is_another([](Scene& s) { s.gravity.y = -9.5f; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.objects[0].positions[3].x += 1e-7f; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.objects[1].volume->pressure = 2; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.objects[1].volume->keyframes = {{0, 2}}; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.objects[1].volume->leak = 1; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.objects[0].pins[0].motion.keyframes[1].time = 2; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.colliders[0].shape = Capsule{0.1f, 0.31f}; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.mesh_colliders.pop_back(); }));
  EXPECT_TRUE(is_another([](Scene& s) { s.pairs[0].thickness = 0.02f; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.frame_time = 0.02f; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.forces.push_back([](const auto&...) { return Vec3f{}; }); }));
  EXPECT_TRUE(has_other_settings([](Scene& s) { s.settings.substeps = 6; }));
  EXPECT_TRUE(has_other_settings([](Scene& s) { s.settings.contact_filter = false; }));
  save(path, World(scene).state());
  EXPECT_NE(with([](Scene&) {}).find("does not say which scene"), std::string::npos);
}

TEST(Save, WhatCannotBeSavedSaysSo) {
  const Folder folder;
  Scene scene = full_scene();
  const World world(scene);
  Scene other = scene;
  other.objects[0].name = "shirt";
  EXPECT_NE(reason([&] { save(folder / "w", world, other); }).find("object 'shirt'"), std::string::npos);
  other = scene;
  other.objects.pop_back();
  EXPECT_NE(reason([&] { save(folder / "w", world, other); }).find("3 objects and the scene 2"), std::string::npos);
  scene.forces.push_back([](const auto&...) { return Vec3f{}; });
  EXPECT_NE(reason([&] { save(folder / "w", World(scene), scene); }).find("force fields"), std::string::npos);
  EXPECT_TRUE(folder.names().empty());
  const std::string nowhere = folder / "no/w";
  EXPECT_EQ(reason([&] { save(nowhere, State{}); }).rfind(nowhere + ": ", 0), 0u);
}

}  // namespace
}  // namespace pliant
