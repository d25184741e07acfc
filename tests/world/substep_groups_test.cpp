// Tests that substeps belong to sets of objects that can meet. Sets with the same number form a group, and each group
// gets the bits that it gets alone. Within a group, sets share the searches of contact between surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <utility>

#include "world/substep_groups_support.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(SubstepGroups, AFlagBesideASockIsAsAlone) {
  World world(scene_of({flag(), sock()}));
  EXPECT_EQ(world.settings().substeps, 0) << "there is no one number";
  EXPECT_EQ(world.object(0).info().substeps, 10);
  EXPECT_EQ(world.object(1).info().substeps, 20);
  EXPECT_EQ(world.step(dt).substeps, 20);
  expect_each_set_as_alone({{flag()}, {sock()}});
  expect_each_set_as_alone({{sock()}, {flag()}});
}

/// Frames, volumes, chains, tethers, attachments and inter-tile constraints have loops of their own, so each kind is
/// tested.
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
  Object large = sheet("large", {-6, 0, 0}, 50);  // it has two tiles
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
  towel.sweep = Sweep::multigrid;  // it collides with itself
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
  run(world, group_frames);
  const auto hash_with = [&](const Settings& settings) {
    World other(scene, settings);
    run(other, group_frames);
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
  scene.wind = {};  // wind needs velocities between substeps, so that substeps would not be fused
  EXPECT_EQ(chosen_substeps(scene), (std::vector<int>{5, 20}));
  World world(scene);
  scene.settings.separate_phases = true;
  World apart(scene);
  run(world, group_frames);
  run(apart, group_frames);
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

TEST(SubstepGroups, ArePlannedAsTheyAreThenMade) {
  for (const float tolerance : {0.f, 1e-5f}) {
    Scene scene = scene_of({flag(), sock()});
    scene.settings.tolerance = tolerance;
    World world(scene);
    const auto numbers = [&] {
      std::vector<int> all;
      for (const ObjectId id : world.objects()) all.push_back(world.object(id).info().substeps);
      return all;
    };
    const std::vector<Object> more{sock(), flag(), sock(), flag()};
    for (std::size_t i = 0; i < more.size(); ++i) {
      world.add(more[i]);
      if (i == 2) world.remove(ObjectId(0));
      const std::vector<int> planned = numbers();
      run(world, 1);
      EXPECT_EQ(numbers(), planned) << tolerance << ", addition " << i;
    }
  }
}

TEST(SubstepGroups, AreFoundAgainWhenObjectsComeAndGo) {
  World alone(scene_of({flag()})), world(scene_of({flag(), sock()}));
  run(alone, group_frames);
  run(world, 10);
  world.remove(ObjectId(1));
  run(world, 10);  // one group from now on
  EXPECT_EQ(world.step(dt).substeps, 10);
  const ObjectId next = world.add(sock());
  EXPECT_EQ(world.object(next).info().substeps, 20) << "before the next step, too";
  EXPECT_EQ(world.step(dt).substeps, 20);
  run(world, group_frames - 22);
  expect_the_same(world, 0, alone, 0);
}

TEST(SubstepGroups, JoinWhenAnObjectBetweenThemComes) {
  Object a = flag();
  a.sweep = Sweep::multigrid;
  a.collides = true;
  a.mask = 2;
  World world(scene_of({a, sock()}));
  run(world, 2);
  EXPECT_EQ(world.object(0).info().substeps, 10);
  Object between = sheet("coat", {1.5f, 0.5f, 0});
  between.sweep = Sweep::tiled;
  between.collides = true;
  between.groups = 2;
  const ObjectId id = world.add(between);
  EXPECT_EQ(world.object(0).info().substeps, 20);
  run(world, 2);
  world.remove(id);
  EXPECT_EQ(world.object(0).info().substeps, 10);
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
  world.remove(ObjectId(1));  // a flag remains, and the number is free
  resumed.remove(ObjectId(1));
  run(world, 5);
  run(resumed, 5);
  const ObjectId one = world.add(sock()), other = resumed.add(sock());
  EXPECT_EQ(world.object(one).info().substeps, 20);
  EXPECT_EQ(resumed.object(other).info().substeps, 20);
  run(world, 5);
  run(resumed, 5);
  EXPECT_EQ(resumed.state_hash(), world.state_hash());
}

}  // namespace
}  // namespace pliant
