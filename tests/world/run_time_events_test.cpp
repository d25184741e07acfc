// Tests contact events with known answers: which things touch, when contact begins and ends, and how hard they touch.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "world/run_time_support.h"

namespace pliant {
namespace {

using namespace testing_support;
using Change = ContactEvent::Change;

Collider level_ground(float height = 0) {
  Collider collider;
  collider.position = {0, height, 0};
  return collider;
}

Object particle_at(const Vec3f& place) {
  Object object = chain(2, 0.1f);
  object.constraints.clear();
  object.positions = {place};
  object.masses = {2};
  return object;
}

TEST(ContactEvents, AreNoneUnlessAskedFor) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.add(particle_at({0, 0, 0}));
  scene.add(level_ground());
  World world(scene);
  world.step(dt);
  EXPECT_TRUE(world.contact_events().empty());
}

TEST(ContactEvents, AParticleAtRestIsPushedByItsWeight) {
  Scene scene;
  scene.settings = settings_of(10);
  scene.add(particle_at({0.3f, 0.001f, -0.2f}));
  scene.add(level_ground());
  World world(scene);
  world.record_contact_events(true);
  for (int frame = 0; frame < 20; ++frame) world.step(dt);
  ASSERT_EQ(world.contact_events().size(), 1u);
  const ContactEvent& event = world.contact_events()[0];
  EXPECT_EQ(event.change, Change::persist);
  EXPECT_EQ(event.first, Thing(ObjectId(0)));
  EXPECT_EQ(event.second, Thing(ColliderId(0)));
  EXPECT_EQ(event.contacts, 1);
  EXPECT_NEAR(event.impulse, 2 * 9.81 * double(dt), 1e-3 * 2 * 9.81 * double(dt));
  EXPECT_NEAR(event.normal.y, 1, 1e-6f);
  EXPECT_NEAR(event.position.x, 0.3f, 1e-4f);
  EXPECT_NEAR(event.position.y, 0.001f, 1e-4f);
  EXPECT_NEAR(event.position.z, -0.2f, 1e-4f);
}

TEST(ContactEvents, AnImpactTakesTheMomentumThatWasThere) {
  Scene scene;
  scene.gravity = {};
  scene.settings = settings_of(10);
  scene.add(particle_at({0, 0.1f, 0}));
  scene.objects[0].velocities = {{0, -3, 0}};
  scene.add(level_ground());
  World world(scene);
  world.record_contact_events(true);
  double impulse = 0;
  std::vector<Change> changes;
  for (int frame = 0; frame < 6; ++frame) {
    world.step(dt);
    for (const ContactEvent& event : world.contact_events()) {
      impulse += event.impulse;
      changes.push_back(event.change);
    }
  }
  EXPECT_NEAR(impulse, 6, 1e-3);
  ASSERT_GE(changes.size(), 2u);
  EXPECT_EQ(changes.front(), Change::begin);
  EXPECT_EQ(changes.back(), Change::end) << "without weight nothing pushes any more";
}

TEST(ContactEvents, SheetsInAStackCarryWhatIsAboveThem) {
  Scene scene;
  scene.settings = settings_of(20);
  for (int i = 0; i < 2; ++i) {
    ClothOptions options;
    options.name = "sheet " + std::to_string(i);
    TriangleMesh mesh = grid_mesh(7, 7, 0.5f, 0.5f);
    for (Vec3f& p : mesh.positions) p.y += 0.011f + 0.0201f * static_cast<float>(i);
    Object object = make_cloth(mesh, options);
    object.collides = true;
    object.thickness = 0.01f;
    scene.add(object);
  }
  scene.add(level_ground());
  World world(scene);
  world.record_contact_events(true);
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  double between = 0, on_ground = 0;
  const int frames = 30;
  for (int frame = 0; frame < frames; ++frame) {
    world.step(dt);
    for (const ContactEvent& event : world.contact_events()) {
      if (event.second == Thing(ObjectId(1))) {
        between += event.impulse / frames;
        EXPECT_LT(event.normal.y, -0.9f) << "the lower one, which comes first, is pushed down";
      }
      if (event.second == Thing(ColliderId(0))) on_ground += event.impulse / frames;
    }
  }
  const double weight = mass_of(scene.objects[0]) * 9.81 * double(dt);
  EXPECT_NEAR(between, weight, 0.1 * weight);
  EXPECT_NEAR(on_ground, 2 * weight, 0.1 * weight);
}

TEST(ContactEvents, AreTheSameOnAnyNumberOfThreads) {
  const auto run = [](int threads) {
    Scene scene = hanging_cloth();
    scene.settings.threads = threads;
    scene.objects[0].self_collision = true;
    scene.add_cloth(sphere_mesh(2));
    scene.objects[1].collides = scene.objects[0].collides = true;
    for (Vec3f& p : scene.objects[1].positions) p = p * 0.2f + Vec3f{0, 0.3f, 0};
    MeshCollider box;
    box.mesh = box_mesh({2, 0.2f, 2});
    for (Vec3f& p : box.mesh.positions) p.y -= 0.7f;
    scene.add(box);
    World world(scene);
    world.record_contact_events(true);
    std::vector<ContactEvent> all;
    for (int frame = 0; frame < 40; ++frame) {
      world.step(dt);
      all.insert(all.end(), world.contact_events().begin(), world.contact_events().end());
      EXPECT_TRUE(std::is_sorted(world.contact_events().begin(), world.contact_events().end(),
                                 [](const auto& a, const auto& b) {
                                   return std::make_pair(a.first, a.second) < std::make_pair(b.first, b.second);
                                 }));
    }
    return all;
  };
  const std::vector<ContactEvent> expected = run(1), found = run(3);
  EXPECT_GT(expected.size(), 20u);
  ASSERT_EQ(expected.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].first, expected[i].first);
    EXPECT_EQ(found[i].second, expected[i].second);
    EXPECT_EQ(found[i].change, expected[i].change);
    EXPECT_EQ(found[i].impulse, expected[i].impulse);
    EXPECT_EQ(found[i].position, expected[i].position);
  }
}

TEST(ContactEvents, DoNotNameWhatWasRemoved) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.add(particle_at({0, 0, 0}));
  scene.add(level_ground());
  World world(scene);
  world.record_contact_events(true);
  for (int frame = 0; frame < 5; ++frame) world.step(dt);
  ASSERT_EQ(world.contact_events().size(), 1u);
  world.remove(ObjectId(0));
  const ObjectId next = world.add(particle_at({0, 0, 0}));
  world.step(dt);
  ASSERT_EQ(world.contact_events().size(), 1u);
  EXPECT_EQ(world.contact_events()[0].first, Thing(next));
  EXPECT_EQ(world.contact_events()[0].change, Change::begin);
}

}  // namespace
}  // namespace pliant
