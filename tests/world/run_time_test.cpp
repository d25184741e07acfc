// Tests objects that are added and removed while a World runs.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>

#include "pliant/error.h"
#include "world/run_time_support.h"

namespace pliant {
namespace {

using namespace testing_support;

Object half_metre_sheet(const std::string& name, const Vec3f& at, int n = 7) { return sheet_at(name, at, n, 0.5f); }

Object pinned_sheet(const std::string& name, const Vec3f& at) {
  Object object = half_metre_sheet(name, at);
  object.pins.push_back({0, {}});
  return object;
}

Collider ball() {
  Collider collider;
  collider.shape = Sphere{0.3f};
  collider.position = {0, -0.5f, 0};
  return collider;
}

/// A static box of triangles below everything.
MeshCollider table() {
  MeshCollider collider;
  collider.name = "table";
  collider.mesh = box_mesh({4, 0.2f, 4});
  for (Vec3f& p : collider.mesh.positions) p.y -= 0.8f;
  return collider;
}

std::vector<Settings> all_sweeps() {
  std::vector<Settings> all;
  for (const NamedSweep& sweep : sweeps()) {
    all.push_back(settings_of(4, sweep.sweep == Sweep::jacobi ? 4 : 1));
    all.back().sweep = sweep.sweep;
    all.back().threads = 2;
  }
  all.push_back(all[0]);
  all.back().iterations = 4;
  all.back().tolerance = 1e-5f;
  all.push_back(settings_of(4, 20));
  all.back().sweep_options.acceleration = SweepOptions::Acceleration::chebyshev;
  all.back().record_residuals = true;
  return all;
}

TEST(RunTime, ObjectsAddedOneByOneGiveTheBitsOfAWorldMadeAtOnce) {
  for (const bool meets : {false, true}) {
    for (const Settings& settings : all_sweeps()) {
      Scene scene;
      scene.settings = settings;
      World grown(scene);
      for (int i = 0; i < 4; ++i) {
        Object object = i % 2 == 0 ? pinned_sheet("a" + std::to_string(i), {0, 0.1f * static_cast<float>(i), 0})
                                   : chain(10 + i, 0.05f);
        object.collides = meets;
        scene.add(object);
        grown.add(object);
      }
      Object balloon = make_cloth(sphere_mesh(1), {.volume = Volume{1.2f, Stiffness::compliance(1e-3f)}});
      scene.add(balloon);
      grown.add(balloon);
      if (meets) {
        scene.add(table());
        grown.add(table());
      }
      scene.add(ball());
      grown.add(ball());
      World made(scene);
      ASSERT_EQ(grown.state_hash(), made.state_hash());
      for (int frame = 0; frame < 15; ++frame) {
        const Report expected = made.step(dt), found = grown.step(dt);
        ASSERT_TRUE(expected.ok());
        ASSERT_EQ(expected.contacts, found.contacts);
      }
      EXPECT_EQ(grown.state_hash(), made.state_hash()) << sweep_name(settings.sweep) << (meets ? ", meeting" : "");
    }
  }
}

TEST(RunTime, WhatIsRemovedLeavesTheOthersTheirBits) {
  Scene scene, without;
  scene.settings = without.settings = settings_of(8);
  scene.add(half_metre_sheet("goes", {3, 0, 0}));
  for (Scene* each : {&scene, &without}) {
    each->add(pinned_sheet("stays", {}));
    each->add(ball());
  }
  World world(scene), alone(without);
  for (int frame = 0; frame < 20; ++frame) {
    if (frame == 7) world.remove(ObjectId(0));
    ASSERT_TRUE(world.step(dt).ok());
    alone.step(dt);
  }
  EXPECT_EQ(world.object(1).positions(), alone.object(0).positions());
  EXPECT_EQ(world.object(1).velocities(), alone.object(0).velocities());
  EXPECT_EQ(world.measure().kinetic_energy(), alone.measure().kinetic_energy());
  EXPECT_EQ(world.object_count(), 1);
  EXPECT_EQ(world.objects(), (std::vector<ObjectId>{1}));
}

TEST(RunTime, AStaleIdIsRefusedAndNeverAnotherObject) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.add(half_metre_sheet("first", {}));
  World world(scene);
  const ObjectId first = 0;
  world.remove(first);
  EXPECT_FALSE(world.has(first));
  const ObjectId second = world.add(half_metre_sheet("second", {}));
  EXPECT_EQ(second.slot, first.slot) << "slots are used again";
  EXPECT_NE(second, first);
  EXPECT_TRUE(world.has(second));
  EXPECT_EQ(world.object(second).info().name, "second");
  EXPECT_THROW(world.object(first).info(), Error);
  EXPECT_THROW(world.object(first).positions(), Error);
  EXPECT_THROW(world.remove(first), Error);
  EXPECT_THROW(world.object(ObjectId(second.slot, second.generation + 1)).info(), Error);
  try {
    world.object(first).mesh();
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("any more"), std::string::npos) << error.what();
  }
  const ColliderId there = world.add(ball());
  world.remove(there);
  EXPECT_THROW((void)world.collider(there).pose(), Error);
  EXPECT_THROW(world.remove(there), Error);
  const MeshColliderId mesh = world.add(table());
  EXPECT_EQ(world.mesh_collider(mesh).positions().size(), table().mesh.positions.size());
  world.remove(mesh);
  EXPECT_THROW(world.mesh_collider(mesh).positions(), Error);
  EXPECT_TRUE(world.step(dt).ok());
}

TEST(RunTime, AnAddedThingTakesPartAndARemovedOneNoLonger) {
  Scene scene;
  scene.settings = settings_of(8);
  scene.add(half_metre_sheet("falls", {}));
  World world(scene);
  for (int frame = 0; frame < 10; ++frame) world.step(dt);
  Collider floor;
  floor.position = {0, -1, 0};
  const ColliderId ground = world.add(floor);
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  for (const Vec3f& p : world.object(0).positions()) EXPECT_NEAR(p.y, -1, 0.01f);
  const Collider second = ball();
  const ColliderId other = world.add(second);
  world.remove(ground);
  EXPECT_EQ(world.collider(other).pose().position.y, second.position.y) << "the id still names it";
  for (int frame = 0; frame < 30; ++frame) world.step(dt);
  for (const Vec3f& p : world.object(0).positions()) EXPECT_LT(p.y, -1.5f);
}

TEST(RunTime, AddedSurfacesMeetOthers) {
  for (const auto as : {MeshCollider::As::triangles, MeshCollider::As::distance_grid}) {
    Scene scene;
    scene.settings = settings_of(8);
    World world(scene);
    MeshCollider collider = table();
    collider.as = as;
    const MeshColliderId under = world.add(collider);
    const ObjectId cloth = world.add(half_metre_sheet("lands", {0, -0.6f, 0}));
    for (int frame = 0; frame < 40; ++frame) world.step(dt);
    for (const Vec3f& p : world.object(cloth).positions()) EXPECT_NEAR(p.y, -0.7f, 0.01f);
    world.remove(under);
    for (int frame = 0; frame < 40; ++frame) world.step(dt);
    for (const Vec3f& p : world.object(cloth).positions()) EXPECT_LT(p.y, -1.5f);
  }
}

TEST(RunTime, KeyframesOfWhatIsAddedAreAtTheWorldsTime) {
  Scene scene;
  scene.settings = settings_of(4);
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) world.step(1.f / 60);
  Object object = chain(3, 0.1f);
  object.pins.push_back({0, straight({1, 0, 0}, 1)});
  const ObjectId id = world.add(object);
  EXPECT_NEAR(world.object(id).positions()[0].x, object.positions[0].x + 0.5f, 1e-6f);
  world.step(1.f / 60);
  EXPECT_NEAR(world.object(id).velocities()[0].x, 1, 1e-3f);
}

TEST(RunTime, StatesBelongToTheObjectsOfTheirTime) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.add(half_metre_sheet("a", {}));
  scene.add(half_metre_sheet("b", {1, 0, 0}));
  World world(scene);
  world.step(dt);
  const State before = world.state();
  world.remove(ObjectId(0));
  EXPECT_THROW(world.restore(before), Error);
  world.add(half_metre_sheet("c", {}));
  EXPECT_EQ(world.state().positions.size(), before.positions.size());
  EXPECT_THROW(world.restore(before), Error) << "as many particles, but another object's";
  const State after = world.state();
  EXPECT_NE(hash(after), hash(before));
  std::vector<std::string> hashes;
  for (int frame = 0; frame < 5; ++frame) {
    world.step(dt);
    hashes.push_back(world.state_hash());
  }
  world.restore(after);
  for (const std::string& expected : hashes) {
    world.step(dt);
    EXPECT_EQ(world.state_hash(), expected);
  }
}

TEST(RunTime, WhatCannotBeSimulatedIsRefusedAndChangesNothing) {
  World world(hanging_cloth());
  world.step(dt);
  const std::string before = world.state_hash();
  Object object = half_metre_sheet("bad", {});
  object.masses[3] = -1;
  EXPECT_THROW(world.add(object), Error);
  Collider collider;
  collider.shape = Sphere{-1};
  EXPECT_THROW(world.add(collider), Error);
  MeshCollider mesh = table();
  mesh.mesh.triangles[0][0] = 100;
  EXPECT_THROW(world.add(mesh), Error);
  EXPECT_EQ(world.state_hash(), before);
  EXPECT_EQ(world.object_count(), 1);
  EXPECT_TRUE(world.step(dt).ok());
}

TEST(RunTime, IntersectionsOfWhatIsAddedAreRefusedWhereTheSceneRefusesThem) {
  const auto box = [](float size, const Vec3f& at, const std::string& name) {
    MeshCollider collider;
    collider.name = name;
    collider.mesh = box_mesh({size, size, size});
    for (Vec3f& p : collider.mesh.positions) p += at;
    return collider;
  };
  Scene scene;
  scene.settings = settings_of(2);
  scene.settings.initial_intersections = Settings::Intersections::refuse;
  scene.gravity = {};
  Object flat = half_metre_sheet("flat", {});
  flat.collides = true;
  flat.velocities.assign(flat.positions.size(), Vec3f{0, 1, 0});
  scene.add(flat);
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(dt).ok());  // it is 1 m higher now
  const std::string before = world.state_hash();
  Object upright = half_metre_sheet("upright", {});
  for (Vec3f& p : upright.positions) p = {p.x + 0.013f, p.z + 0.007f, 0.01f};
  upright.collides = true;
  const auto at_height = [&](float y) {
    Object moved = upright;
    for (Vec3f& p : moved.positions) p.y += y;
    return moved;
  };
  const auto refused = [&](const auto& what) {
    try {
      world.add(what);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused(at_height(1)).find("passes through triangle"), std::string::npos);
  EXPECT_NE(refused(box(0.2f, {0, 1, 0}, "through")).find("'through'"), std::string::npos);
  EXPECT_NE(refused(box(4, {0, 1, 0}, "around")).find("is inside of closed collider 'around'"), std::string::npos);
  MeshCollider grid = box(4, {0, 1, 0}, "grid");
  grid.as = MeshCollider::As::distance_grid;
  grid.field = measure_distances(grid.mesh, 0.2f);
  EXPECT_NE(refused(grid).find("is inside of distance grid 'grid'"), std::string::npos);
  EXPECT_EQ(world.state_hash(), before);
  EXPECT_EQ(world.object_count(), 1);
  EXPECT_TRUE(world.mesh_colliders().empty());
  Object apart = at_height(1);
  apart.groups = 2;  // no object meets this group, so it may be anywhere
  apart.mask = 2;
  EXPECT_EQ(refused(apart), "");
  EXPECT_EQ(refused(at_height(0)), "") << "where the sheet was at the start";
  EXPECT_TRUE(world.step(dt).ok());
}

/// Makes the same random additions, removals and steps; returns a hash of all that remains.
std::string random_life(int threads, int changes, std::size_t& largest) {
  std::mt19937 random(11);
  Scene scene;
  scene.settings = settings_of(2);
  scene.settings.threads = threads;
  World world(scene);
  world.add(ball());
  std::vector<ObjectId> live;
  for (int change = 0; change < changes; ++change) {
    const bool adds = live.size() < 10 || (live.size() < 40 && random() % 2 == 0);
    if (adds) {
      const int kind = static_cast<int>(random() % 3);
      const float x = static_cast<float>(random() % 100) * 0.01f;
      live.push_back(world.add(kind == 0   ? half_metre_sheet("sheet", {x, 0, 0}, 3 + static_cast<int>(random() % 5))
                               : kind == 1 ? chain(2 + static_cast<int>(random() % 20), 0.1f)
                                           : pinned_sheet("hangs", {0, x, 0})));
    } else {
      const std::size_t at = random() % live.size();
      world.remove(live[at]);
      live.erase(live.begin() + static_cast<std::ptrdiff_t>(at));
    }
    largest = std::max(largest, world.state().positions.size());
    if (change % 20 != 0) continue;
    EXPECT_TRUE(world.step(dt).ok());
  }
  EXPECT_EQ(world.object_count(), static_cast<int>(live.size()));
  return world.state_hash();
}

TEST(RunTime, RandomAddsAndRemovesGiveTheSameBitsAndNoMoreMemory) {
  std::size_t after_few = 0, after_many = 0, ignored = 0;
  random_life(1, 400, after_few);
  const std::string expected = random_life(1, 2000, after_many);
  EXPECT_LE(after_many, after_few + after_few / 2);
  for (const int threads : {2, 4}) EXPECT_EQ(random_life(threads, 2000, ignored), expected) << threads;
}

}  // namespace
}  // namespace pliant
