// Emitters, drains and lifetimes: what comes and goes is counted, is where it should be, and follows from the State alone.
#include "pliant/flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/gas.h"
#include "pliant/gauges.h"
#include "pliant/grains.h"
#include "pliant/io.h"
#include "pliant/liquid.h"
#include "pliant/save.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr float spacing = 0.02f, frame = 1.f / 60;

/// A square nozzle of 5 by 5 particles that points down.
Emitter nozzle(float speed) {
  Emitter emitter;
  emitter.position = {0, 1, 0};
  emitter.width = emitter.height = 5 * spacing;
  emitter.speed = speed;
  return emitter;
}

Scene jet(const Emitter& emitter, int capacity = 20000, const std::vector<Drain>& drains = {}, float lifetime = 0) {
  Scene scene;
  LiquidOptions options;
  options.fluid.spacing = spacing;
  options.flow = {{emitter}, drains, lifetime};
  options.capacity = capacity;
  scene.add(make_liquid({}, options));
  scene.settings.threads = 1;
  return scene;
}

/// Sums over frames.
FlowReport run(World& world, int frames) {
  FlowReport sum;
  for (int i = 0; i < frames; ++i) {
    const Report report = world.step(frame);
    EXPECT_TRUE(report.ok()) << report.explain();
    sum.emitted += report.flow.emitted;
    sum.drained += report.flow.drained;
    sum.expired += report.flow.expired;
    sum.refused += report.flow.refused;
    sum.blocked += report.flow.blocked;
    sum.present = report.flow.present;
  }
  return sum;
}

std::int64_t living(const World& world) { return static_cast<std::int64_t>(world.object(0).present().size()); }

TEST(Flow, EmitsTheVolumeOfFlowTimesTime) {
  Emitter emitter = nozzle(0);
  emitter.flow = 0.0123f;
  for (const bool is_disc : {false, true}) {
    if (is_disc) emitter.width = emitter.height = 0, emitter.radius = 3.2f * spacing;
    World world(jet(emitter));
    const FlowReport sum = run(world, 60);
    const auto held = static_cast<double>(2 * layer_of(emitter, jet(emitter).objects[0]).places.size());
    const double layer = held / 2 * std::pow(spacing, 3);
    EXPECT_NEAR((static_cast<double>(sum.emitted) - held) * std::pow(spacing, 3), 0.0123, layer);
    EXPECT_EQ(sum.emitted, living(world));
    EXPECT_EQ(sum.blocked + sum.refused + sum.drained + sum.expired, 0);
  }
}

TEST(Flow, HasTheFlowOfASpeedAndThePlacesOfALattice) {
  Emitter emitter = nozzle(2);
  const Scene scene = jet(emitter);
  const EmitterLayer layer = layer_of(emitter, scene.objects[0]);
  EXPECT_EQ(layer.places.size(), 25u);
  EXPECT_FLOAT_EQ(layer.speed, 2);
  EXPECT_FLOAT_EQ(layer.distance, spacing);
  EXPECT_NEAR(layer.flow, 2 * 0.01, 1e-6);
  emitter.width = emitter.height = 0, emitter.radius = 0.5f * spacing;
  EXPECT_EQ(layer_of(emitter, scene.objects[0]).places.size(), 1u);
  emitter.radius = 1.5f * spacing;
  EXPECT_EQ(layer_of(emitter, scene.objects[0]).places.size(), 5u);
}

/// Every particle is where its age says: x = x0 + v t + g t^2 / 2. A jet that does not spread keeps its lattice.
TEST(Flow, JetsFollowTheParabola) {
  Emitter emitter = nozzle(3);
  emitter.direction = {1, 0, 0};  // one that rises slows down, and so becomes thicker
  World world(jet(emitter));
  run(world, 30);
  const std::vector<Vec3f> places = world.object(0).positions(), velocities = world.object(0).velocities();
  const std::vector<double> ages = world.object(0).ages();
  const double v = 3;
  double worst_speed = 0, worst_place = 0;
  double seen = 0;
  for (const int i : world.object(0).present()) {
    const auto p = static_cast<std::size_t>(i);
    const double t = ages[p];
    if (t < 0.1) continue;
    ++seen;
    worst_speed =
        std::max({worst_speed, std::abs(double(velocities[p].x) - v), std::abs(double(velocities[p].y) + 9.81 * t)});
    const double x = v * t, y = 1 - 9.81 * t * t / 2;
    worst_place = std::max(worst_place, std::hypot(double(places[p].x) - x, double(places[p].y) - y) - 2.5 * spacing);
  }
  EXPECT_GT(seen, 500);
  EXPECT_LT(worst_speed, 0.15) << "of 3 m/s";
  EXPECT_LT(worst_place, spacing);
}

/// Layers neither overlap nor gap: the nearest neighbour in a horizontal jet without gravity is a spacing away.
TEST(Flow, LayersFollowAtTheSpacingOfTheLiquid) {
  for (const float speed : {0.3f, 2.f, 8.f}) {
    Scene scene = jet(nozzle(speed));
    scene.gravity = {};
    World world(scene);
    run(world, 20);
    const std::vector<Vec3f> places = world.object(0).present_positions();
    ASSERT_GT(places.size(), 100u);
    for (const Vec3f& a : places) {
      float nearest = 1;
      for (const Vec3f& b : places)
        if (!(a == b)) nearest = std::min(nearest, std::sqrt(length_squared(a - b)));
      EXPECT_NEAR(nearest, spacing, 0.02f * spacing);
    }
  }
}

TEST(Flow, CountsEverythingThatComesAndGoes) {
  Drain drain;
  drain.shape = Box{{1, 0.1f, 1}};
  drain.position = {0, 0.3f, 0};
  World world(jet(nozzle(2), 3000, {drain}));
  const FlowReport sum = run(world, 90);
  EXPECT_GT(sum.drained, 1000);
  EXPECT_EQ(sum.emitted, sum.drained + living(world));
  EXPECT_EQ(sum.present, living(world));
  EXPECT_EQ(sum.refused + sum.blocked, 0) << "drained particles are used again";
  for (const Vec3f& p : world.object(0).present_positions()) EXPECT_GT(p.y, 0.1f);
}

TEST(Flow, ObeysTheCapacity) {
  World world(jet(nozzle(2), 130));
  const FlowReport sum = run(world, 30);
  EXPECT_EQ(sum.emitted, 130);
  EXPECT_EQ(living(world), 130);
  EXPECT_EQ(sum.emitted + sum.refused, 25 * 52) << "30 frames of 2 m/s are 50 layers, and the opening holds two";
}

TEST(Flow, EndsLives) {
  World world(jet(nozzle(2), 5000, {}, 0.25f));
  FlowReport sum = run(world, 60);
  EXPECT_EQ(sum.emitted, sum.expired + living(world));
  EXPECT_NEAR(static_cast<double>(living(world)), 25 * 27, 2 * 25) << "a quarter of a second of 100 layers a second";
  for (const double age : world.object(0).ages()) EXPECT_LE(age, 0.25 + 1.01 / 60);
}

TEST(Flow, StartsAndEnds) {
  Emitter emitter = nozzle(2);
  emitter.start = 0.25f;
  emitter.end = 0.5f;
  World world(jet(emitter));
  EXPECT_EQ(run(world, 14).emitted, 0);
  EXPECT_EQ(run(world, 46).emitted, 25 * 25);
}

TEST(Flow, EmitsToTheEndWhateverTheStep) {
  Emitter emitter = nozzle(2);
  emitter.end = 0.3f;
  for (const float dt : {0.3f / 7, 1.f / 60, 0.004f}) {
    World world(jet(emitter));
    std::int64_t emitted = 0;
    while (world.state().time < 0.5) emitted += world.step(dt).flow.emitted;
    EXPECT_EQ(emitted, 30 * 25) << "100 layers a second, steps of " << dt;
  }
}

TEST(Flow, EndsWithTheNearestWholeLayer) {
  for (const auto& [end, layers] : {std::pair{0.1049f, 10}, std::pair{0.1051f, 11}, std::pair{0.0049f, 0}}) {
    Emitter emitter = nozzle(2);
    emitter.end = end;
    World world(jet(emitter));
    EXPECT_EQ(run(world, 30).emitted, layers * 25) << end;
  }
}

TEST(Flow, WhatFindsNoParticleIsRefusedAndNotBlocked) {
  Scene scene = jet(nozzle(0.5f), 60);
  scene.gravity = {};
  Collider lid;  // what it emits stays at the opening
  lid.position = {0, 1 - spacing, 0};
  scene.add(lid);
  World world(scene);
  const FlowReport sum = run(world, 120);
  EXPECT_EQ(sum.emitted, 60);
  EXPECT_GT(sum.refused, 0);
  const FlowReport full = run(world, 60);
  EXPECT_EQ(full.emitted + full.blocked, 0);
  EXPECT_EQ(full.refused, 25 * 25) << "a second of 25 layers, all of which lack particles";
}

TEST(Flow, AnEditedRateHoldsAtOnce) {
  for (const float speed : {0.5f, 4.f}) {
    World world(jet(nozzle(2)));
    run(world, 30);
    world.edit({0}, unchanged(jet(nozzle(speed)).objects[0]));
    const auto emitted = static_cast<double>(run(world, 30).emitted);
    EXPECT_NEAR(emitted / 25, speed / spacing / 2, 3);
  }
}

TEST(Flow, AnEditLeavesTheOpeningWhatItHolds) {
  const Scene scene = jet(nozzle(2));
  World world(scene), edited(scene);
  run(world, 30);
  run(edited, 30);
  edited.edit({0}, unchanged(scene.objects[0]));
  EXPECT_EQ(world.object(0).present(), edited.object(0).present());
  EXPECT_EQ(world.object(0).velocities(), edited.object(0).velocities());
  run(edited, 60);
  const std::vector<Vec3f> places = edited.object(0).positions(), speeds = edited.object(0).velocities();
  for (const int i : edited.object(0).present()) {
    const auto particle = static_cast<std::size_t>(i);
    if (places[particle].y > 0.9f) {
      EXPECT_NEAR(speeds[particle].y, -2, 0.8) << "it falls";
    }
  }
}

TEST(Flow, LeavesFixedParticlesWhereTheyAre) {
  Scene scene = jet(nozzle(2));
  scene.objects[0].positions.insert(scene.objects[0].positions.begin(), {0.5f, 0.5f, 0.5f});
  scene.objects[0].masses.insert(scene.objects[0].masses.begin(), std::numeric_limits<float>::infinity());
  World world(scene);
  run(world, 30);
  EXPECT_EQ(world.object(0).positions().front(), (Vec3f{0.5f, 0.5f, 0.5f}));
}

TEST(Flow, NeitherALifetimeNorADrainTakesFixedParticles) {
  Drain everywhere;
  everywhere.shape = Box{{9, 9, 9}};
  Scene scene = jet(nozzle(2), 20000, {everywhere}, 0.1f);
  scene.objects[0].positions.insert(scene.objects[0].positions.begin(), {0.5f, 0.5f, 0.5f});
  scene.objects[0].masses.insert(scene.objects[0].masses.begin(), std::numeric_limits<float>::infinity());
  World world(scene);
  EXPECT_GT(run(world, 30).drained, 0);
  const std::vector<int> present = world.object(0).present();
  ASSERT_FALSE(present.empty());
  EXPECT_EQ(present.front(), 0);
}

TEST(Flow, AMovingOpeningGivesItsVelocity) {
  Emitter emitter = nozzle(1);
  emitter.motion.keyframes = {{0, {0, 0, 0}, {}}, {1, {2, 0, 0}, {}}};
  Scene scene = jet(emitter);
  scene.gravity = {};
  World world(scene);
  run(world, 30);
  for (const int i : world.object(0).present()) {
    const Vec3f v = world.object(0).velocities()[static_cast<std::size_t>(i)];
    EXPECT_NEAR(v.x, 2, 0.02);
    EXPECT_NEAR(v.y, -1, 0.02);
  }
}

TEST(Flow, CountsWhatIsInItsWay) {
  Scene scene = jet(nozzle(0.5f), 5000);
  Object& liquid = scene.objects[0];
  const std::vector<Vec3f> plug = fill_box({-0.06f, 0.9f, -0.06f}, {0.06f, 1.2f, 0.06f}, spacing / 2);
  liquid.positions.insert(liquid.positions.begin(), plug.begin(), plug.end());
  liquid.masses.insert(liquid.masses.begin(), plug.size(), std::numeric_limits<float>::infinity());
  World world(scene);
  const FlowReport sum = run(world, 60);
  EXPECT_EQ(sum.emitted, 0);
  EXPECT_NEAR(static_cast<double>(sum.blocked), 25 * (0.5 / 0.02 + 2), 25);
}

TEST(Flow, DoesNotEmitIntoWhatIsThere) {
  Scene scene = jet(nozzle(0.5f), 5000);
  Collider cup;
  cup.position = {0, 1 - spacing, 0};  // the nozzle is almost closed
  scene.add(cup);
  World world(scene);
  const FlowReport sum = run(world, 60);
  EXPECT_EQ(sum.emitted, living(world));
  for (const Vec3f& v : world.object(0).velocities()) EXPECT_LT(std::sqrt(length_squared(v)), 5);
}

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
      const auto writer = make_frame_writer((folder / "a").string() + suffix, scene, world, {.liquid_surfaces = surfaces});
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
