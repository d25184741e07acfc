// The overstretch of every frame and the worst of any: equal to a plain loop in doubles over what the World returns,
// and to a fresh measurement, on any threads and instruction set, while objects come and go.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "pliant/material.h"
#include "support/kernels.h"
#include "support/scenes.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr int measured_substeps = 6;

/// A sheet of 12 x 12, hung by a row of pins, so that some of its edges join two fixed particles.
Object sheet_on_pins(const std::string& name, const Stiffness& stretch, float x, Sweep sweep = Sweep::automatic) {
  Scene scene;
  ClothOptions options;
  options.name = name;
  options.stretch = stretch;
  scene.add_cloth(grid_mesh(12, 12, 1, 1), options);
  for (int i = 0; i < 4; ++i) scene.pin(0, {i});
  for (Vec3f& p : scene.objects[0].positions) p.x += x;
  scene.objects[0].sweep = sweep;
  return scene.objects[0];
}

/// Cloth of all kinds of stiffness and of several sweeps, and a damped rope.
Scene all_kinds() {
  Scene scene;
  scene.add(sheet_on_pins("rigid", Stiffness::rigid(), 0));
  scene.add(sheet_on_pins("elastic", Stiffness::compliance(2e-4f), 2));
  scene.add(sheet_on_pins("elastic chains", Stiffness::compliance(2e-4f), 4, Sweep::chains));
  scene.add(sheet_on_pins("multigrid", Stiffness::compliance(1e-5f), 6, Sweep::multigrid));
  scene.add(sheet_on_pins("damped", Stiffness::compliance(2e-4f, 25.f), 8));
  scene.add(sheet_on_pins("pbd", Stiffness::pbd(0.2f), 10));
  Object rope = chain(12, 0.1f, Stiffness::compliance(1e-4f, 50.f));
  rope.pins = {{0, {}}};
  for (Vec3f& p : rope.positions) p.x += 12;
  scene.add(rope);
  scene.settings = settings_of(measured_substeps);
  scene.settings.record_multipliers = true;
  return scene;
}

double value_of(const ConstraintGroup& group, std::size_t i) {
  return double(i < group.compliances.size() ? group.compliances[i] : group.stiffness.value);
}

/// (C + alpha~ lambda + (alpha beta - h) d|x|/dt) / L of each distance of an object that has a multiplier and a free
/// end.
void add_overstretches(const World& world, ObjectId id, const Object& object, std::vector<double>& all) {
  const std::vector<Vec3f> x = world.object(id).positions(), v = world.object(id).velocities();
  const std::vector<float> multipliers = world.object(id).multipliers("distance");
  const auto is_fixed = [&](int particle) {
    return std::any_of(object.pins.begin(), object.pins.end(),
                       [&](const Pin& pin) { return pin.particle == particle; });
  };
  const double h = double(dt) / measured_substeps;
  std::size_t number = 0;
  for (const ConstraintGroup& group : object.constraints) {
    if (group.type != "distance") continue;
    for (std::size_t i = 0; 2 * i + 1 < group.particles.size(); ++i, ++number) {
      const int a = group.particles[2 * i], b = group.particles[2 * i + 1];
      if (group.stiffness.kind == Stiffness::Kind::pbd || (is_fixed(a) && is_fixed(b))) continue;
      const Vec3d way = convert<double>(x[b] - x[a]), speed = convert<double>(v[b] - v[a]);
      const Vec3f start = object.positions[b] - object.positions[a];
      const double rest = i < group.rest.size() ? double(group.rest[i]) : double(length(start));
      const double length = std::sqrt(dot(way, way)), compliance = value_of(group, i);
      const double lambda = number < multipliers.size() ? double(multipliers[number]) : 0;
      const double time = std::max(compliance * double(group.stiffness.damping) - h, 0.);
      const double damping = time * dot(way, speed) / length;
      all.push_back((length - rest + compliance / (h * h) * lambda + damping) / rest);
    }
  }
}

/// 99th percentile and maximum by a full sort; 0 where nothing is too long.
Overstretch sorted_out(std::vector<double> all) {
  Overstretch found;
  found.constraints = static_cast<std::int64_t>(all.size());
  if (all.empty()) return found;
  std::sort(all.begin(), all.end());
  found.p99 = std::max(0., all[static_cast<std::size_t>(0.99 * static_cast<double>(all.size() - 1))]);
  found.largest = std::max(0., all.back());
  return found;
}

void expect_same(const Overstretch& a, const Overstretch& b, const std::string& where) {
  EXPECT_EQ(a.p99, b.p99) << where;
  EXPECT_EQ(a.largest, b.largest) << where;
  EXPECT_EQ(a.object, b.object) << where;
  EXPECT_EQ(a.particles, b.particles) << where;
  EXPECT_EQ(a.constraints, b.constraints) << where;
}

TEST(OverstretchOfAFrame, IsThatOfAPlainLoopInDoubles) {
  const Scene scene = all_kinds();
  World world(scene);
  double most = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const Report report = world.step(dt);
    std::vector<double> all;
    for (const ObjectId id : world.objects()) add_overstretches(world, id, scene.objects[id.slot], all);
    const Overstretch expected = sorted_out(all), found = report.overstretch.value();
    EXPECT_EQ(found.constraints, expected.constraints);
    EXPECT_NEAR(found.p99, expected.p99, 2e-6) << frame;
    EXPECT_NEAR(found.largest, expected.largest, 2e-6) << frame;
    most = std::max(most, found.p99);
  }
  EXPECT_GT(most, 0.01) << "or this shows nothing";
}

TEST(OverstretchOfAFrame, IsThatOfAFreshMeasurement) {
  Scene scene = all_kinds();
  scene.settings.record_multipliers = false;
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) {
    const Report report = world.step(dt);
    expect_same(*report.overstretch, world.measure().overstretch(), "frame " + std::to_string(frame));
  }
}

/// A sheet that falls flat has no overstretch at all; then it meets a ball, and later it rests.
TEST(OverstretchOfAFrame, FollowsAnImpactFromNothing) {
  Scene scene;
  scene.add_cloth(grid_mesh(30, 30, 1, 1), {});
  Collider ball;
  ball.shape = Sphere{0.3f};
  ball.position = {0, -0.6f, 0};
  scene.add(ball);
  World world(scene);
  Overstretch first, worst;
  for (int frame = 0; frame < 60; ++frame) {
    const Report report = world.step(dt);
    if (frame == 0) first = *report.overstretch;
    expect_same(*report.overstretch, world.measure().overstretch(), "frame " + std::to_string(frame));
    worst.p99 = std::max(worst.p99, report.overstretch->p99);
  }
  EXPECT_LT(first.p99, 1e-6);
  EXPECT_GT(worst.p99, 1e-3);
}

TEST(OverstretchOfAFrame, HasTheSameBitsOnAnyThreadsAndInstructionSet) {
  Scene scene = all_kinds();
  scene.settings.record_multipliers = false;
  const auto run = [&](int threads, const std::string& isa) {
    scene.settings.threads = threads;
    scene.settings.isa = isa;
    World world(scene);
    std::vector<Overstretch> found;
    found.reserve(20);
    for (int frame = 0; frame < 20; ++frame) found.push_back(*world.step(dt).overstretch);
    return found;
  };
  const std::vector<Overstretch> expected = run(1, "sequential");
  const auto compare = [&](int threads, const std::string& isa) {
    const std::vector<Overstretch> found = run(threads, isa);
    for (std::size_t frame = 0; frame < found.size(); ++frame)
      expect_same(found[frame], expected[frame], isa + " x " + std::to_string(threads));
  };
  for (const std::string& isa : available_isas()) compare(1, isa);
  for (const int threads : {2, 3}) compare(threads, "");
}

TEST(OverstretchOfAFrame, IsTheSameWhereFewMultipliersAreStoredAndChangesNoBitOfTheState) {
  Scene scene = all_kinds();
  World all(scene);
  scene.settings.record_multipliers = false;
  World none(scene);
  for (int frame = 0; frame < 20; ++frame) {
    const Report expected = all.step(dt), found = none.step(dt);
    expect_same(*found.overstretch, *expected.overstretch, "frame " + std::to_string(frame));
  }
  EXPECT_EQ(all.state_hash(), none.state_hash());
}

TEST(OverstretchOfAFrame, IsEmptyIfTheFrameWasNotCompleted) {
  World world(all_kinds());
  const Report before = world.step(dt);
  std::atomic<bool> stop{true};
  world.stop_when(&stop);
  const Report stopped = world.step(dt);
  EXPECT_TRUE(stopped.stopped);
  EXPECT_FALSE(stopped.overstretch.has_value());
  expect_same(stopped.worst_overstretch.overstretch, before.worst_overstretch.overstretch, "stopped");
  world.stop_when(nullptr);
  EXPECT_FALSE(world.step(-1).overstretch.has_value());
  EXPECT_TRUE(world.step(dt).overstretch.has_value());
}

TEST(OverstretchOfAFrame, IsEmptyIfItWasStoppedMidway) {
  std::atomic<bool> stop{false};
  Scene scene = all_kinds();
  scene.forces.emplace_back([&](const Vec3f&, const Vec3f&, float, float time) {
    if (time > 0.02f) stop = true;
    return Vec3f{};
  });
  World world(scene);
  world.stop_when(&stop);
  EXPECT_TRUE(world.step(dt).overstretch.has_value());
  const Report report = world.step(dt);
  EXPECT_TRUE(report.stopped);
  EXPECT_FALSE(report.overstretch.has_value());
}

/// The worst of Reports, collected one after another.
struct Collected {
  Overstretch worst;
  std::int64_t frame_of_p99 = 0, frame_of_largest = 0;

  void add(const Report& report) {
    const Overstretch& now = report.overstretch.value();
    if (now.p99 > worst.p99) frame_of_p99 = report.frame;
    worst.p99 = std::max(worst.p99, now.p99);
    worst.constraints = now.constraints;
    if (!(now.largest > worst.largest)) return;
    frame_of_largest = report.frame;
    worst.largest = now.largest;
    worst.object = now.object;
    worst.particles = now.particles;
  }
  void expect(const WorstOverstretch& found) const {
    expect_same(found.overstretch, worst, "worst");
    EXPECT_EQ(found.frame_of_p99, frame_of_p99);
    EXPECT_EQ(found.frame_of_largest, frame_of_largest);
  }
};

TEST(WorstOverstretch, IsThatOfAllFramesWhileObjectsComeAndGo) {
  Scene scene;
  scene.add(sheet_on_pins("first", Stiffness::rigid(), 0));
  scene.settings = settings_of(measured_substeps);
  World world(scene);
  Collected collected;
  ObjectId added{};
  for (int frame = 0; frame < 60; ++frame) {
    if (frame == 20) added = world.add(sheet_on_pins("second", Stiffness::rigid(), 2, Sweep::tiled));
    if (frame == 40) world.remove(ObjectId{0});
    if (frame == 40 && collected.worst.object == 0)
      collected.worst.object = collected.worst.particles[0] = collected.worst.particles[1] = -1;
    const Report report = world.step(dt);
    collected.add(report);
    collected.expect(report.worst_overstretch);
    expect_same(*report.overstretch, world.measure().overstretch(), "frame " + std::to_string(frame));
  }
  EXPECT_GT(collected.frame_of_largest, 1);
  EXPECT_EQ(world.object(added).info().name, "second");
}

TEST(WorstOverstretch, NamesNoObjectThatWasRemovedOrEdited) {
  for (const bool edits : {false, true}) {
    const Object object = sheet_on_pins("only", Stiffness::rigid(), 0);
    Scene scene;
    scene.add(object);
    scene.settings = settings_of(2);
    World world(scene);
    Report report;
    for (int frame = 0; frame < 20; ++frame) report = world.step(dt);
    ASSERT_EQ(report.worst_overstretch.overstretch.object, 0);
    const double largest = report.worst_overstretch.overstretch.largest;
    if (edits)
      world.edit({0}, unchanged(object));
    else
      world.remove(ObjectId{0});
    report = world.step(1e-4f);
    EXPECT_EQ(report.worst_overstretch.overstretch.object, -1);
    EXPECT_EQ(report.worst_overstretch.overstretch.particles[0], -1);
    EXPECT_EQ(report.worst_overstretch.overstretch.largest, largest);
    EXPECT_NE(world.measure().advice(report.worst_overstretch.overstretch), "");
  }
}

TEST(WorstOverstretch, BeginsAnewWhenAStateIsRestored) {
  Scene scene;
  scene.add(sheet_on_pins("only", Stiffness::rigid(), 0));
  scene.settings = settings_of(2);
  World world(scene), same(scene);
  const State start = world.state();
  Report report;
  for (int frame = 0; frame < 30; ++frame) report = world.step(dt);
  const WorstOverstretch before = report.worst_overstretch;
  world.restore(start);
  report = world.step(dt);
  EXPECT_LT(report.worst_overstretch.overstretch.largest, before.overstretch.largest);
  EXPECT_EQ(report.worst_overstretch.overstretch.largest, report.overstretch->largest);
  for (int frame = 1; frame < 30; ++frame) report = world.step(dt);
  expect_same(report.worst_overstretch.overstretch, before.overstretch, "run again");
  EXPECT_EQ(report.worst_overstretch.frame_of_p99, before.frame_of_p99);
}

TEST(OverstretchOfAFrame, IsNothingWithoutDistances) {
  Scene scene;
  scene.add(loose_particles({{0, 0, 0}, {1, 0, 0}}));
  World world(scene);
  const Report report = world.step(dt);
  ASSERT_TRUE(report.overstretch.has_value());
  EXPECT_EQ(report.overstretch->constraints, 0);
  EXPECT_EQ(report.overstretch->object, -1);
  EXPECT_TRUE(is_tolerable(*report.overstretch));
}

/// The multipliers of an earlier frame do not explain the stretch of the present one.
TEST(OverstretchOfAFrame, CountsTheWholeStretchAfterAFrameThatWasStopped) {
  Scene scene;
  Object rope = chain(40, 0.1f, Stiffness::compliance(2e-4f));
  rope.pins = {{0, {}}};
  scene.add(rope);
  scene.settings = settings_of(40);
  std::atomic<bool> flag{false};
  float last = 1e9f;
  scene.forces.push_back([&](const Vec3f&, const Vec3f&, float, float time) {
    if (time > last) flag = true;
    return Vec3f{};
  });
  World world(scene);
  for (int frame = 0; frame < 40; ++frame) world.step(dt);
  last = static_cast<float>(world.state().time) + 0.5f * dt;
  world.stop_when(&flag);
  ASSERT_TRUE(world.step(dt).stopped);
  const Overstretch found = world.measure().overstretch();
  World other(scene);
  other.restore(world.state());
  expect_same(found, other.measure().overstretch(), "where no multiplier is known");
  EXPECT_GT(found.largest, 0.01);
}

TEST(OverstretchInWords, OfAnObjectThatIsGoneReadsNothingOfAnother) {
  Scene scene;
  scene.add(sheet_on_pins("first", Stiffness::rigid(), 0));
  scene.settings = settings_of(2);
  World world(scene);
  Report report;
  for (int frame = 0; frame < 30; ++frame) report = world.step(dt);
  const std::string before = world.measure().advice(report), gone = "an object that was removed or edited stretched";
  EXPECT_NE(before.find("object 'first': stretched"), std::string::npos) << before;
  world.remove(ObjectId(0));
  EXPECT_NE(world.measure().advice(report).find(gone), std::string::npos) << world.measure().advice(report);
  EXPECT_NE(world.measure().describe(*report.overstretch).find(gone), std::string::npos);
  Object small = chain(3, 0.1f);
  const ObjectId id = world.add(small);  // in the same slot
  ASSERT_EQ(id.slot, report.overstretch->object);
  EXPECT_NE(world.measure().advice(report).find(gone), std::string::npos) << world.measure().advice(report);
  EXPECT_NE(world.measure().advice(report.worst_overstretch.overstretch).find(gone), std::string::npos);
  Overstretch of_small = *report.overstretch;
  of_small.generation = id.generation;  // particles that the object lacks, as after an edit
  EXPECT_NE(world.measure().describe(of_small).find(gone), std::string::npos);
  of_small.object = 99;
  EXPECT_NE(world.measure().describe(of_small).find(gone), std::string::npos);
  of_small.object = id.slot;
  of_small.particles = {0, 1};
  EXPECT_NE(world.measure().describe(of_small).find("object 'chain': stretched"), std::string::npos);
}

}  // namespace
}  // namespace pliant
