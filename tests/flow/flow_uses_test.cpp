// Emitters, drains and lifetimes with the rest: the State, contact, gauges, files and errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "flow_support.h"
#include "pliant/error.h"
#include "pliant/gas.h"
#include "pliant/gauges.h"
#include "pliant/grains.h"
#include "pliant/io.h"
#include "pliant/liquid.h"
#include "pliant/save.h"

namespace pliant {
namespace {

using namespace testing_support;

// ------------------------------------------------------------------------------------------------ the State

Scene busy(int threads) {
  Drain drain;
  drain.shape = Box{{1, 0.1f, 1}};
  drain.position = {0, 0.2f, 0};
  Scene scene = jet(nozzle(2), 2000, {drain}, 0.5f);
  GrainsOptions sand;
  sand.grains.radius = 0.02f;
  Emitter emitter = nozzle(1.5f);
  emitter.name = "sand";
  emitter.position = {0.05f, 1.2f, 0.03f};
  emitter.width = emitter.height = 0, emitter.radius = 0.1f;
  sand.flow = {{emitter}, {drain}, 0.7f};
  sand.capacity = 300;
  scene.add(make_grains({}, sand));
  scene.settings.threads = threads;
  return scene;
}

TEST(FlowState, GivesTheSameBitsOnAnyThreads) {
  World one(busy(1)), two(busy(2));
  run(one, 40);
  run(two, 40);
  EXPECT_EQ(hash(one.state()), hash(two.state()));
}

TEST(FlowState, GivesTheSameBitsAfterRestoring) {
  World world(busy(1)), other(busy(1));
  run(world, 33);
  const State kept = world.state();
  const FlowReport after = run(world, 20);
  const std::string expected = hash(world.state());
  world.restore(kept);
  EXPECT_EQ(run(world, 20).emitted, after.emitted);
  EXPECT_EQ(hash(world.state()), expected);
  other.restore(kept);
  run(other, 20);
  EXPECT_EQ(hash(other.state()), expected);
}

TEST(FlowState, SavesWhoIsThere) {
  const std::string path = testing::TempDir() + "flow.pliant";
  World world(busy(1));
  run(world, 25);
  save(path, world, busy(1));
  World loaded = load_world(path).world;
  EXPECT_EQ(hash(loaded.state()), hash(world.state()));
  run(world, 20);
  run(loaded, 20);
  EXPECT_EQ(hash(loaded.state()), hash(world.state()));
  std::filesystem::remove(path);
}

TEST(FlowState, RefusesAnotherState) {
  World world(busy(1));
  run(world, 10);
  State state = world.state();
  state.births.clear();
  EXPECT_THROW(world.restore(state), Error);
  state = world.state();
  state.births[0] = NAN;
  EXPECT_THROW(world.restore(state), Error);
  state = world.state();
  const auto gone = std::find(state.births.begin(), state.births.end(), not_there) - state.births.begin();
  state.positions[static_cast<std::size_t>(gone)].w = 1;
  EXPECT_THROW(world.restore(state), Error);
  state = world.state();
  state.emitted.push_back({99, 0, 1});
  EXPECT_THROW(world.restore(state), Error);
}

TEST(FlowState, AScenesHistoryChangesNothing) {
  World world(busy(1)), other(busy(1));
  const ObjectId extra = other.add(jet(nozzle(1)).objects[0]);
  run(other, 1);
  other.remove(extra);
  World third(busy(1));
  run(third, 1);
  EXPECT_EQ(other.state().emitted, third.state().emitted);
  run(world, 1);
  EXPECT_EQ(world.object(0).present(), other.object(0).present());
}

// ------------------------------------------------------------------------------------------------ contact

/// What is not there touches nothing: neither colliders, cloth, grains nor liquids.
TEST(FlowContact, WhatIsNotThereTouchesNothing) {
  Scene scene;
  ClothOptions options;
  options.name = "sheet";
  const int sheet = scene.add_cloth(grid_mesh(9, 9, 0.4f, 0.4f), options);
  scene.objects[static_cast<std::size_t>(sheet)].collides = true;
  World alone(scene);
  Emitter emitter = nozzle(1);
  emitter.position = {0.0f, -0.05f, 0};  // where the sheet falls through
  emitter.start = 100;
  LiquidOptions water;
  water.fluid.spacing = spacing;
  water.flow.emitters = {emitter};
  water.capacity = 500;
  scene.add(make_liquid({}, water));
  World with(scene);
  for (int i = 0; i < 20; ++i) {
    alone.step(frame);
    const Report report = with.step(frame);
    EXPECT_EQ(report.contacts, 0);
    EXPECT_EQ(report.pairs.contacts, 0);
  }
  float lowest = 0, lowest_alone = 0;
  for (const Vec3f& p : with.object(0).positions()) lowest = std::min(lowest, p.y);
  for (const Vec3f& p : alone.object(0).positions()) lowest_alone = std::min(lowest_alone, p.y);
  EXPECT_NEAR(lowest, lowest_alone, 2e-3);
  EXPECT_LT(lowest, -0.3);
}

/// Grains poured on ground become a heap that lies still, and none is lost or gets wild.
TEST(FlowContact, GrainsBecomeAHeap) {
  Scene scene;
  GrainsOptions sand;
  sand.grains.radius = 0.02f;
  Emitter emitter = nozzle(1);
  emitter.width = emitter.height = 0, emitter.radius = 0.08f;
  emitter.position = {0, 0.5f, 0};
  emitter.end = 0.5f;
  sand.flow.emitters = {emitter};
  sand.capacity = 400;
  scene.add(make_grains({}, sand));
  Collider ground;
  ground.static_friction = ground.kinetic_friction = 1;
  scene.add(ground);
  scene.settings.threads = 1;
  World world(scene);
  const FlowReport sum = run(world, 150);
  EXPECT_EQ(sum.emitted, living(world));
  EXPECT_GT(sum.emitted, 50);
  double fastest = 0;
  for (const Vec3f& v : world.object(0).velocities()) fastest = std::max(fastest, double(length_squared(v)));
  EXPECT_LT(std::sqrt(fastest), 0.3);
  for (const Vec3f& p : world.object(0).present_positions()) EXPECT_GT(p.y, 0.015f);
}

// ------------------------------------------------------------------------------------------------ readers

TEST(FlowOutput, GaugesAndFilesLeaveOutWhatIsNotThere) {
  const Scene scene = jet(nozzle(2), 2000);
  World world(scene);
  Gauges gauges({{.name = "all", .measures = HeightGauge{{-1, -3, -1}, {1, 3, 1}}, .liquids = {}},
                 {.name = "gate", .measures = FlowGauge{{-1, 0.8f, -1}, {2, 0, 0}, {0, 0, 2}}, .liquids = {}}},
                scene, world);
  gauges.read(world);
  double volume = 0, passed = 0;
  const std::string path = testing::TempDir() + "flow_out.ply";
  const auto writer = make_frame_writer(path, scene, world);
  for (int i = 0; i < 20; ++i) {
    world.step(frame);
    const std::vector<double> values = gauges.read(world);
    volume = values[0] * 4;
    passed += std::abs(values[1]) / 60;
    writer->add(world);
  }
  writer->finish();
  const std::vector<double> ages = world.object(0).ages();
  const auto out = std::count_if(ages.begin(), ages.end(), [](double age) { return age >= 0; });
  EXPECT_NEAR(volume, static_cast<double>(out) * std::pow(spacing, 3), 1e-6) << "without what the opening holds";
  double below = 0;
  for (const Vec3f& p : world.object(0).present_positions()) below += p.y < 0.8f ? std::pow(spacing, 3) : 0;
  EXPECT_NEAR(passed, below, 30 * std::pow(spacing, 3));
  std::string head(300, ' ');
  std::ifstream(writer->written().back().path, std::ios::binary).read(head.data(), 300);
  EXPECT_NE(head.find("element vertex " + std::to_string(living(world)) + "\n"), std::string::npos) << head;
  for (const WrittenFile& file : writer->written()) std::filesystem::remove(file.path);
}

/// Every format takes a run that begins without a particle.
TEST(FlowOutput, EveryFormatTakesParticlesThatCome) {
  Emitter emitter = nozzle(2);
  emitter.start = 0.05f;
  const Scene scene = jet(emitter, 2000);
  const std::filesystem::path folder = testing::TempDir() + "flow_formats";
  std::filesystem::create_directories(folder);
  for (const bool surfaces : {false, true})
    for (const char* suffix : {".obj", ".ply", ".usda", ".pvd", ".glb", ".pc2"}) {
      if (surfaces && (std::string(suffix) == ".glb" || std::string(suffix) == ".pc2")) continue;
      World world(scene);
      const auto writer =
          make_frame_writer((folder / "a").string() + suffix, scene, world, {.liquid_surfaces = surfaces});
      writer->add(world);
      for (int i = 0; i < 10; ++i) {
        world.step(frame);
        writer->add(world);
      }
      EXPECT_NO_THROW(writer->finish()) << suffix;
    }
  std::filesystem::remove_all(folder);
}

TEST(FlowRefusal, SaysWhatIsWrong) {
  const auto refused = [](const std::function<void(Object&)>& change, const std::string& words) {
    Scene scene = jet(nozzle(2), 100);
    change(scene.objects[0]);
    try {
      World world(scene);
      ADD_FAILURE() << "no error: " << words;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  refused([](Object& o) { o.flow.emitters[0].direction = {}; }, "has no length");
  refused([](Object& o) { o.flow.emitters[0].radius = 1; }, "neither a disc nor a rectangle");
  refused([](Object& o) { o.flow.emitters[0].flow = 1; }, "neither a speed nor a flow");
  refused([](Object& o) { o.flow.emitters[0].speed = NAN; }, "speed");
  refused([](Object& o) { o.flow.emitters[0].end = -1; }, "ends before it starts");
  refused([](Object& o) { o.flow.spare = 101; }, "spare particles");
  refused([](Object& o) { o.flow.emitters[0].width = 1000; }, "has room for about");
  refused([](Object& o) { o.flow.emitters[0] = {.radius = 1000, .speed = 1}; }, "has room for about");
  refused([](Object& o) { o.flow.lifetime = -1; }, "lifetime");
  refused([](Object& o) { o.pins.push_back({0, {}}); }, "pins");
  refused([](Object& o) { o.clusters.push_back({.particles = {0, 1}, .rest = {{0, 0, 0}, {1, 0, 0}}}); }, "clusters");
  refused([](Object& o) { o.gas = Gas{}; }, "is of a gas");
  refused([](Object& o) { o.fluid.reset(); }, "neither a liquid nor grains");
  EXPECT_THROW((void)make_liquid(fill_box({}, {1, 1, 1}, 0.5f), {.capacity = 7}), Error);
}

}  // namespace
}  // namespace pliant
