// Tests groups of substeps within a frame: reports, stopping, division, events and control use each group's own
// substeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <utility>

#include "world/substep_groups_support.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(SubstepGroups, AddUpInTheReport) {
  Scene scene = scene_of({flag(), sock()});
  World world(scene), one(scene_of({flag()})), other(scene_of({sock()}));
  std::int64_t contacts = 0, among_surfaces = 0;
  for (int frame = 0; frame < group_frames; ++frame) {
    const Report report = world.step(dt), a = one.step(dt), b = other.step(dt);
    ASSERT_EQ(report.contacts, a.contacts + b.contacts);
    ASSERT_EQ(report.pairs.candidates, b.pairs.candidates);
    ASSERT_EQ(report.pairs.contacts, b.pairs.contacts);
    among_surfaces += b.pairs.contacts;
    ASSERT_EQ(report.iterations.smallest, 1);
    ASSERT_EQ(report.iterations.mean, 1);
    ASSERT_EQ(report.time, a.time);
    contacts += std::min(a.contacts, b.contacts);
  }
  EXPECT_GT(contacts, 0) << "or this shows nothing";
  EXPECT_GT(among_surfaces, 0) << "or this shows nothing";
}

/// The residual C + alpha~ lambda of each object must be measured with the length of its own substeps.
TEST(SubstepGroups, AreMeasuredWithTheirOwnSubsteps) {
  World world(scene_of({flag(), sock()})), one(scene_of({flag()})), other(scene_of({sock()}));
  for (World* each : {&world, &one, &other}) run(*each, 20);
  const std::vector<Residual> sum = world.measure().residuals(), a = one.measure().residuals(),
                              b = other.measure().residuals();
  ASSERT_EQ(sum.size(), a.size());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    SCOPED_TRACE(sum[i].type);
    EXPECT_EQ(sum[i].largest, std::max(a[i].largest, b[i].largest));
    const double squares =
        double(a[i].constraints) * a[i].rms * a[i].rms + double(b[i].constraints) * b[i].rms * b[i].rms;
    EXPECT_NEAR(sum[i].rms, std::sqrt(squares / double(sum[i].constraints)), 1e-9 * sum[i].rms);
  }
}

TEST(SubstepGroups, StopWhereAllHaveReachedTheSameTime) {
  for (const int at : {1, 3, 4, 29, 30, 31}) {
    SCOPED_TRACE(at);
    std::atomic<bool> stop{false};
    int asked = 0;
    Scene scene = scene_of({flag(), sock()});
    scene.wind = {};
    // Called for each free particle in each substep of its object; counted for one particle of each object.
    scene.forces.push_back([&](const Vec3f&, const Vec3f&, float, float) { return ++asked, Vec3f{}; });
    World world(scene);
    world.step(dt);
    const int in_a_frame = asked;
    asked = 0;
    scene.forces[0] = [&](const Vec3f&, const Vec3f&, float, float) {
      if (++asked == at * in_a_frame / 31) stop = true;
      return Vec3f{};
    };
    World stopped(scene);
    const State before = stopped.state();
    stopped.stop_when(&stop);
    const Report report = stopped.step(dt);
    const double tenth = stopped.state().time / (double(dt) / 10);
    EXPECT_NEAR(tenth, std::round(tenth), 1e-9) << "the end of a substep of both";
    EXPECT_EQ(report.stopped, tenth < 9.5);
    EXPECT_EQ(stopped.state().frame, report.stopped ? 0 : 1);
    // All objects have moved up to this time, so a freely falling one has the velocity of that time.
    stopped.stop_when(nullptr);
    stop = false;
    stopped.restore(before);
    stopped.step(dt);
    EXPECT_EQ(stopped.state_hash(), world.state_hash()) << "the frame made again";
  }
}

/// The positions in free fall show up to which time each group has moved.
TEST(SubstepGroups, HaveAllMovedAsFarWhereTheyStop) {
  std::atomic<bool> stop{false};
  Object falling = flag(), other = sheet("sock", {0, -0.5f, 3}, 14);
  falling.pins.clear();
  other.pins.clear();
  other.self_collision = true;
  Scene scene;
  scene.add(falling);
  scene.add(other);
  scene.forces.push_back([&](const Vec3f& x, const Vec3f&, float, float) {
    if (x.y < -0.5005f) stop = true;
    return Vec3f{};
  });
  World world(scene);
  world.stop_when(&stop);
  const Report report = world.step(0.1f);
  ASSERT_TRUE(report.stopped);
  const double time = world.state().time;
  EXPECT_GT(time, 0);
  for (const int o : {0, 1})
    for (const Vec3f& v : world.object(o).velocities()) ASSERT_NEAR(v.y, -9.81 * time, 1e-5) << o;
}

TEST(SubstepGroups, AreDividedEachForTheFastCollidersThatItMeets) {
  Scene scene = scene_with_floor();
  scene.add(flag());
  scene.add(sock());
  MeshCollider fast;
  fast.name = "fast";
  fast.mesh = sphere_mesh(2);
  for (Vec3f& p : fast.mesh.positions) p = 0.1f * p + Vec3f{-0.7f, -0.5f, 3};
  fast.mask = 2;
  fast.motion = straight({2, 0, 0}, 0.2f);
  scene.objects[1].groups = 2;
  scene.add(fast);
  World world(scene), alone(scene_of({flag()}));
  const Report report = world.step(dt);
  EXPECT_GT(report.substeps, 20);
  alone.step(dt);
  run(world, 10);
  run(alone, 10);
  expect_the_same(world, 0, alone, 0);
}

TEST(SubstepGroups, NameWhatIsNotFiniteAndLeaveAFiniteState) {
  Scene scene = scene_of({flag(), sock()});
  World world(scene);
  std::vector<Vec3f> velocities = world.object(1).velocities();
  velocities[20] = {3e38f, 0, 0};
  world.object(ObjectId(1)).set_velocities(velocities);
  const Report report = world.step(dt);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.nonfinite->object, "sock");
  EXPECT_TRUE(is_finite(world.state()));
  EXPECT_FALSE(world.step(dt).ok());
}

/// The numbers of contacts in an object's events, and their impulses.
std::vector<std::pair<int, double>> events_of(const World& world, int object) {
  std::vector<std::pair<int, double>> found;
  for (const ContactEvent& event : world.contact_events())
    if (event.first == Thing(ObjectId(object))) found.emplace_back(event.contacts, event.impulse);
  return found;
}

TEST(SubstepGroups, TellTheirContactsAsEvents) {
  World world(scene_of({flag(), sock()})), one(scene_of({flag()})), other(scene_of({sock()}));
  std::size_t most = 0;
  for (World* each : {&world, &one, &other}) each->record_contact_events(true);
  for (int frame = 0; frame < group_frames; ++frame) {
    for (World* each : {&world, &one, &other}) each->step(dt);
    ASSERT_EQ(events_of(world, 0), events_of(one, 0)) << frame;
    ASSERT_EQ(events_of(world, 1), events_of(other, 0)) << frame;
    most = std::max(most, std::min(one.contact_events().size(), other.contact_events().size()));
  }
  EXPECT_GT(most, 0u) << "or this shows nothing";
}

TEST(SubstepGroups, MoveTargetsAndGivenForcesInTheirOwnTime) {
  const auto push = [](World& world, ObjectId object) {
    const std::vector<int> pins{0};
    const std::vector<Vec3f> to{world.object(object).positions()[0] + Vec3f{0.01f, 0, 0}};
    world.object(object).set_targets(pins, to);
    world.object(object).set_forces(std::vector<Vec3f>(world.object(object).positions().size(), {0, 0.001f, 0}));
  };
  World world(scene_of({flag(), sock()})), one(scene_of({flag()})), other(scene_of({sock()}));
  for (int frame = 0; frame < 10; ++frame) {
    push(world, 0);
    push(world, 1);
    push(one, 0);
    push(other, 0);
    for (World* each : {&world, &one, &other}) each->step(dt);
  }
  expect_the_same(world, 0, one, 0);
  expect_the_same(world, 1, other, 0);
}

/// The scene names no number of substeps; the settings of a World made of it do.
TEST(SubstepGroups, AreOneForALayoutWithATolerance) {
  Scene scene = scene_of({flag(), sock()});
  scene.settings.tolerance = 1e-5f;
  scene.settings.iterations = 4;
  World world(scene);
  World again(scene, world.layout());
  EXPECT_EQ(again.object(0).info().substeps, world.object(0).info().substeps);
  run(world, 5);
  run(again, 5);
  EXPECT_EQ(again.state_hash(), world.state_hash());
}

TEST(SubstepGroups, NameTheSubstepInWhichAFrameIsNotFinite) {
  Object spinner;
  spinner.name = "spinner";
  spinner.positions = {{3, 1, 0}, {3.5f, 1, 0}};
  spinner.masses = {1, 1};
  spinner.sweep = Sweep::tiled;
  spinner.frames.resize(2);
  for (ObjectFrame& frame : spinner.frames) frame.inertia = {0.1f, 0.2f, 0.3f};
  spinner.frames[0].angular_velocity = {3e37f, 3e37f, 2e37f};
  Scene scene = scene_of({flag(), spinner});
  scene.wind = {};
  for (const bool separate : {false, true}) {
    scene.settings.separate_phases = separate;
    const Report report = World(scene).step(dt);
    ASSERT_TRUE(report.nonfinite.has_value());
    EXPECT_EQ(report.nonfinite->object, "spinner");
    EXPECT_EQ(report.nonfinite->substep, 0);
  }
}

}  // namespace
}  // namespace pliant
