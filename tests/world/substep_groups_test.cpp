// Substeps belong to sets of objects that can meet; sets of one number are a group, and each group gets the bits that it gets
// alone. Within a group sets with contact among surfaces share its searches and rounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <utility>

#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

Object sheet(const std::string& name, const Vec3f& at, int n = 12) {
  ClothOptions options;
  options.name = name;
  options.stretch = Stiffness::compliance(1e-7f);
  TriangleMesh mesh = grid_mesh(n, n, 1, 1);
  for (Vec3f& p : mesh.positions) p += at;
  Object cloth = make_cloth(mesh, options);
  cloth.pins = {{0, {}}, {n - 1, {}}};
  cloth.thickness = 0.005f;
  cloth.drag = 1;
  return cloth;
}

/// By `multigrid`, 10 substeps.
Object flag() { return sheet("flag", {0, 0.5f, 0}); }

/// It touches itself, so it is solved by `tiled` in 20 substeps. It lies in two layers, which fall onto the floor.
Object sock() {
  Object object = sheet("sock", {0, -0.6f, 3}, 14);
  for (Vec3f& p : object.positions)
    if (p.z > 3) p = {p.x, p.y + 0.02f, 6 - p.z};
  object.pins = {{0, {}}};
  object.self_collision = true;
  return object;
}

/// What flag and sock share: air, a ball that moves under the flag, a floor that the sock falls on.
Scene surroundings() {
  Scene scene;
  scene.wind.velocity = {1, 0, 2};
  scene.wind.gust = 0.5f;
  scene.wind.air_density = 1.2f;
  Collider ball, floor;
  ball.shape = Sphere{0.2f};
  ball.position = {-0.3f, 0.2f, 0};
  ball.motion = straight({1, 0, 0}, 1);
  floor.position = {0, -0.75f, 0};
  scene.add(ball);
  scene.add(floor);
  scene.settings.threads = 2;
  return scene;
}

Scene scene_of(const std::vector<Object>& objects) {
  Scene scene = surroundings();
  for (const Object& object : objects) scene.add(object);
  return scene;
}

template <class T>
void expect_equal_bits(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  if (a.empty()) return;
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(T)), 0);
}

constexpr int frames = 40;

/// Object `o` of a World has the positions and velocities of object `other` of another.
void expect_the_same(const World& world, ObjectId o, const World& alone, ObjectId other) {
  expect_equal_bits(world.positions(o), alone.positions(other));
  expect_equal_bits(world.velocities(o), alone.velocities(other));
  expect_equal_bits(world.orientations(o), alone.orientations(other));
}

void run(World& world, int count = frames) {
  for (int frame = 0; frame < count; ++frame) ASSERT_TRUE(world.step(dt).ok());
}

/// All of `sets` together; each set has the bits that it gets alone.
void expect_each_set_as_alone(const std::vector<std::vector<Object>>& sets) {
  Scene scene = surroundings();
  for (const std::vector<Object>& set : sets)
    for (const Object& object : set) scene.add(object);
  World together(scene);
  run(together);
  int o = 0;
  for (const std::vector<Object>& set : sets) {
    World alone(scene_of(set));
    run(alone);
    for (int i = 0; i < static_cast<int>(set.size()); ++i, ++o) {
      SCOPED_TRACE(set[static_cast<std::size_t>(i)].name);
      EXPECT_EQ(together.info(o).substeps, alone.info(i).substeps);
      expect_the_same(together, o, alone, i);
    }
  }
}

TEST(SubstepGroups, AFlagBesideASockIsAsAlone) {
  World world(scene_of({flag(), sock()}));
  EXPECT_EQ(world.settings().substeps, 0) << "there is no one number";
  EXPECT_EQ(world.info(0).substeps, 10);
  EXPECT_EQ(world.info(1).substeps, 20);
  EXPECT_EQ(world.step(dt).substeps, 20);
  expect_each_set_as_alone({{flag()}, {sock()}});
  expect_each_set_as_alone({{sock()}, {flag()}});
}

/// Frames, volumes, chains, tethers, attachments and inter-tile constraints each have loops of their own.
TEST(SubstepGroups, ObjectsOfEveryKindAreAsAlone) {
  Object spinner = loose_particles({{3, 1, 0}, {3.5f, 1, 0}});
  spinner.name = "spinner";
  spinner.frames.resize(2);
  spinner.frames[0].angular_velocity = {1, 5, 2};
  spinner.frames[1].angular_velocity = {0, -3, 1};
  for (ObjectFrame& frame : spinner.frames) frame.inertia = {0.1f, 0.2f, 0.3f};
  ClothOptions options;
  options.name = "balloon";
  options.volume = Volume{1.2f, Stiffness::compliance(1e-7f)};
  TriangleMesh mesh = sphere_mesh(2);
  for (Vec3f& p : mesh.positions) p = 0.2f * p + Vec3f{-2, 0, 0};
  const Object balloon = make_cloth(mesh, options);
  Object rope = chain(60, 0.02f, Stiffness::compliance(1e-6f)), held = sheet("held", {6, 0, 0});
  rope.pins = {{0, {}}};
  Object large = sheet("large", {-6, 0, 0}, 50);  // of two tiles
  held.pins.clear();
  for (const int i : {0, 11}) held.attachments.push_back({i, held.positions[i], {}, Stiffness::compliance(1e-4f)});
  expect_each_set_as_alone({{spinner}, {rope}, {balloon}, {held}, {large}, {flag()}});
  rope.sweep = Sweep::chains;
  large.sweep = Sweep::jacobi;
  held.sweep = Sweep::symmetric;
  expect_each_set_as_alone({{rope}, {large}, {flag()}, {held}});
}

TEST(SubstepGroups, TwoGroupsWithContactAmongSurfacesAreAsAlone) {
  Object towel = sock(), cape = sock();
  for (Vec3f& p : towel.positions) p.x += 4;
  towel.name = "towel";
  towel.sweep = Sweep::multigrid;  // and touches itself
  for (Vec3f& p : cape.positions) p.x -= 4;
  cape.name = "cape";
  cape.collides = true;
  cape.sweep = Sweep::multigrid;
  Object scarf = cape;
  scarf.name = "scarf";
  scarf.sweep = Sweep::automatic;
  for (Vec3f& p : scarf.positions) p.y += 0.05f;
  expect_each_set_as_alone({{towel}, {sock()}, {flag()}});
  expect_each_set_as_alone({{towel}, {cape, scarf}});
}

TEST(SubstepGroups, ThoseThatCanMeetShareThem) {
  Object a = flag(), b = sheet("coat", {0, 0.5f, 0.5f}), c = sheet("lining", {0, 0.5f, 1});
  a.collides = b.collides = c.collides = true;
  a.sweep = Sweep::multigrid;
  a.groups = 1;
  b.groups = 2;
  c.groups = 4;
  a.mask = 2;
  b.mask = 1;
  c.mask = 4;
  b.sweep = Sweep::tiled;
  c.sweep = Sweep::multigrid;
  EXPECT_EQ(chosen_substeps(scene_of({a, b, c})), (std::vector<int>{20, 20, 10}));
  b.mask = 4;
  EXPECT_EQ(chosen_substeps(scene_of({a, b, c})), (std::vector<int>{10, 20, 10})) << "not all of them agree to meet";
  b.mask = 5;
  c.mask = 2;
  EXPECT_EQ(chosen_substeps(scene_of({a, b, c})), (std::vector<int>{20, 20, 20})) << "through the one between";
  const World world(scene_of({a, b, c}));
  EXPECT_EQ(world.settings().substeps, 20);
}

TEST(SubstepGroups, MeshCollidersJoinWhatTheyTouchOnlyAsTriangles) {
  Object a = flag();
  a.sweep = Sweep::multigrid;
  Scene scene = scene_of({a, sock()});
  MeshCollider body;
  body.name = "body";
  body.mesh = sphere_mesh(2);
  for (Vec3f& p : body.mesh.positions) p = 0.1f * p + Vec3f{0, -3, 0};
  body.as = MeshCollider::As::distance_grid;
  scene.add(body);
  EXPECT_EQ(chosen_substeps(scene), (std::vector<int>{10, 20}));
  World world(scene);
  run(world, 2);
  scene.mesh_colliders[0].as = MeshCollider::As::triangles;
  EXPECT_EQ(chosen_substeps(scene), (std::vector<int>{20, 20}));
  scene.mesh_colliders[0].mask = 2;
  EXPECT_EQ(chosen_substeps(scene), (std::vector<int>{10, 20}));
}

TEST(SubstepGroups, AreOneWhereANumberOrAToleranceIsGiven) {
  Scene scene = scene_of({flag(), sock()});
  scene.settings.substeps = 7;
  EXPECT_EQ(chosen_substeps(scene), (std::vector<int>{7, 7}));
  EXPECT_EQ(World(scene).step(dt).substeps, 7);
  scene.settings.substeps = 0;
  scene.settings.tolerance = 1e-4f;
  EXPECT_EQ(chosen_substeps(scene), (std::vector<int>{20, 20}));
  EXPECT_EQ(World(scene).settings().substeps, 20);
  scene.settings.tolerance = 0;
  scene.settings.record_residuals = true;
  EXPECT_EQ(chosen_settings(scene).substeps, 20);
}

TEST(SubstepGroups, KeepObjectsOfConvertedStiffnessAtTheirNumber) {
  Object pbd = flag();
  pbd.sweep = Sweep::multigrid;
  EXPECT_EQ(chosen_substeps(scene_of({pbd})), std::vector<int>{10});
  pbd.constraints[1].stiffness = Stiffness::pbd(0.5f);
  pbd.constraints[1].compliances.clear();
  EXPECT_EQ(chosen_substeps(scene_of({pbd})), std::vector<int>{20});
  pbd.constraints[1].stiffness = Stiffness::pbd(1);
  EXPECT_EQ(chosen_substeps(scene_of({pbd})), std::vector<int>{10}) << "it is rigid whatever the number";
  pbd.attachments.push_back({5, pbd.positions[5], {}, Stiffness::pbd(0.5f)});
  EXPECT_EQ(chosen_substeps(scene_of({pbd})), std::vector<int>{20});
}

TEST(SubstepGroups, GiveTheSameBitsOnThreadsAndInScalarForm) {
  Scene scene = scene_of({flag(), sock()});
  World world(scene);
  run(world);
  const auto hash_with = [&](const Settings& settings) {
    World other(scene, settings);
    run(other);
    return other.state_hash();
  };
  for (const int threads : {1, 3}) {
    Settings settings = scene.settings;
    settings.threads = threads;
    EXPECT_EQ(hash_with(settings), world.state_hash()) << threads << " threads";
  }
  Settings settings = scene.settings;
  settings.isa = "sequential";
  EXPECT_EQ(hash_with(settings), world.state_hash());
}

TEST(SubstepGroups, GiveTheSameBitsUnfused) {
  Object stiff = sheet("stiff", {3, 0.5f, 0});
  stiff.sweep = Sweep::tiled;
  Scene scene = scene_of({flag(), stiff});
  scene.wind = {};  // its forces need velocities between substeps, which are never fused then
  EXPECT_EQ(chosen_substeps(scene), (std::vector<int>{10, 20}));
  World world(scene);
  scene.settings.separate_phases = true;
  World apart(scene);
  run(world);
  run(apart);
  EXPECT_EQ(apart.state_hash(), world.state_hash());
}

TEST(SubstepGroups, GoOnFromAStateThatIsPutBack) {
  const Scene scene = scene_of({flag(), sock()});
  World world(scene), other(scene);
  run(world, 20);
  const State middle = world.state();
  run(world, 20);
  other.restore(middle);
  run(other, 20);
  EXPECT_EQ(other.state_hash(), world.state_hash());
}

TEST(SubstepGroups, AreFoundAgainWhenObjectsComeAndGo) {
  World alone(scene_of({flag()})), world(scene_of({flag(), sock()}));
  run(alone);
  run(world, 10);
  world.remove(ObjectId(1));
  run(world, 10);  // one group now
  EXPECT_EQ(world.step(dt).substeps, 10);
  const ObjectId next = world.add(sock());
  EXPECT_EQ(world.info(next).substeps, 20) << "before the next step, too";
  EXPECT_EQ(world.step(dt).substeps, 20);
  run(world, frames - 22);
  expect_the_same(world, 0, alone, 0);
}

TEST(SubstepGroups, JoinWhenAnObjectBetweenThemComes) {
  Object a = flag();
  a.sweep = Sweep::multigrid;
  a.collides = true;
  a.mask = 2;
  World world(scene_of({a, sock()}));
  run(world, 2);
  EXPECT_EQ(world.info(0).substeps, 10);
  Object between = sheet("coat", {5, 0.5f, 0});
  between.collides = true;
  between.groups = 2;
  const ObjectId id = world.add(between);
  EXPECT_EQ(world.info(0).substeps, 20);
  run(world, 2);
  world.remove(id);
  EXPECT_EQ(world.info(0).substeps, 10);
  run(world, 2);
}

TEST(SubstepGroups, AreThoseOfAWorldMadeFromALayout) {
  Scene scene = scene_of({flag(), sock(), flag()});
  World world(scene);
  run(world, 5);
  world.remove(ObjectId(0));
  run(world, 5);
  scene.objects.erase(scene.objects.begin());
  scene.settings = world.settings();
  World resumed(scene, world.layout());
  resumed.restore(world.state());
  world.remove(ObjectId(1));  // a flag is left, and the number stays open
  resumed.remove(ObjectId(1));
  run(world, 5);
  run(resumed, 5);
  const ObjectId one = world.add(sock()), other = resumed.add(sock());
  EXPECT_EQ(world.info(one).substeps, 20);
  EXPECT_EQ(resumed.info(other).substeps, 20);
  run(world, 5);
  run(resumed, 5);
  EXPECT_EQ(resumed.state_hash(), world.state_hash());
}

TEST(SubstepGroups, AddUpInTheReport) {
  Scene scene = scene_of({flag(), sock()});
  World world(scene), one(scene_of({flag()})), other(scene_of({sock()}));
  std::int64_t contacts = 0, among_surfaces = 0;
  for (int frame = 0; frame < frames; ++frame) {
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

/// The residual C + alpha~ lambda of each object counts with its own length of a substep.
TEST(SubstepGroups, AreMeasuredWithTheirOwnSubsteps) {
  World world(scene_of({flag(), sock()})), one(scene_of({flag()})), other(scene_of({sock()}));
  for (World* each : {&world, &one, &other}) run(*each, 20);
  const std::vector<Residual> sum = world.residuals(), a = one.residuals(), b = other.residuals();
  ASSERT_EQ(sum.size(), a.size());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    SCOPED_TRACE(sum[i].type);
    EXPECT_EQ(sum[i].largest, std::max(a[i].largest, b[i].largest));
    const double squares = double(a[i].constraints) * a[i].rms * a[i].rms + double(b[i].constraints) * b[i].rms * b[i].rms;
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
    // Called for each free particle of the object whose substep it is; counted for one particle of each.
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
    // Both have moved so far: what falls freely has the velocity of that time.
    stopped.stop_when(nullptr);
    stop = false;
    stopped.restore(before);
    stopped.step(dt);
    EXPECT_EQ(stopped.state_hash(), world.state_hash()) << "the frame made again";
  }
}

/// Free fall says how far each group has come.
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
    for (const Vec3f& v : world.velocities(o)) ASSERT_NEAR(v.y, -9.81 * time, 1e-5) << o;
}

TEST(SubstepGroups, AreDividedEachForTheFastCollidersThatItMeets) {
  Scene scene = surroundings();
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
  std::vector<Vec3f> velocities = world.velocities(1);
  velocities[20] = {3e38f, 0, 0};
  world.set_velocities(ObjectId(1), velocities);
  const Report report = world.step(dt);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.nonfinite->object, "sock");
  EXPECT_TRUE(is_finite(world.state()));
  EXPECT_FALSE(world.step(dt).ok());
}

/// How many contacts the events of an object have, and their impulses.
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
  for (int frame = 0; frame < frames; ++frame) {
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
    const std::vector<Vec3f> to{world.positions(object)[0] + Vec3f{0.01f, 0, 0}};
    world.set_targets(object, pins, to);
    world.set_forces(object, std::vector<Vec3f>(world.positions(object).size(), {0, 0.001f, 0}));
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

/// A scene names neither number; the settings of a World of it do.
TEST(SubstepGroups, AreOneForALayoutWithATolerance) {
  Scene scene = scene_of({flag(), sock()});
  scene.settings.tolerance = 1e-5f;
  scene.settings.iterations = 4;
  World world(scene);
  World again(scene, world.layout());
  EXPECT_EQ(again.info(0).substeps, world.info(0).substeps);
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
