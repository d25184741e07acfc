// Tests contact events of things that bounce: their impulses are the changes of momentum, and each bounce is one
// contact that begins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/joint.h"
#include "pliant/mesh.h"
#include "world/run_time_support.h"

namespace pliant {
namespace {

using namespace testing_support;
using Change = ContactEvent::Change;

Object ball(const Vec3f& position, const Vec3f& velocity, float restitution, float mass = 1) {
  Object object = make_body({{Sphere{0.5f}}}, {.position = position, .velocity = velocity, .mass = mass});
  object.restitution = restitution;
  return object;
}

Scene weightless(int substeps) {
  Scene scene;
  scene.gravity = {};
  scene.settings = settings_of(substeps);
  return scene;
}

/// What the events of two things sum up to.
struct Sum {
  double impulse = 0;
  Vec3d push{};
  std::vector<Change> changes;
  int begins() const { return static_cast<int>(std::count(changes.begin(), changes.end(), Change::begin)); }
};

Sum events_of(World& world, int frames, const Thing& first, const Thing& second) {
  world.record_contact_events(true);
  Sum sum;
  for (int frame = 0; frame < frames; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    for (const ContactEvent& event : world.contact_events()) {
      if (event.first != first || event.second != second) continue;
      sum.impulse += event.impulse;
      sum.push += event.push;
      sum.changes.push_back(event.change);
    }
  }
  return sum;
}

/// Expects one contact, with an impulse that is known within a share. What does not bounce stays where it is, and
/// touches on without a weight, so that rounding begins and ends contacts.
void expect_bounce(const Sum& sum, double impulse, double share, float restitution, const std::string& where) {
  EXPECT_NEAR(sum.impulse, impulse, share * impulse) << where;
  EXPECT_NEAR(std::sqrt(length_squared(sum.push)), impulse, share * impulse) << where;
  if (restitution > 0) {
    EXPECT_EQ(sum.begins(), 1) << where;
  }
  EXPECT_FALSE(sum.changes.empty()) << where;
  if (!sum.changes.empty()) {
    EXPECT_EQ(sum.changes.front(), Change::begin) << where;
  }
}

std::string words(float restitution, int substeps) {
  return "restitution " + std::to_string(restitution) + ", " + std::to_string(substeps) + " substeps";
}

TEST(BounceEvents, OfABallOnAPlaneHaveTheChangeOfMomentum) {
  for (const float e : {1.f, 0.8f, 0.3f, 0.f})
    for (const int substeps : {1, 4, 8, 20}) {
      Scene scene = weightless(substeps);
      scene.add(ball({0, 1.5f, 0}, {0, -3, 0}, e));
      scene.add(Collider{});
      World world(scene);
      const Sum sum = events_of(world, 60, ObjectId(0), ColliderId(0));
      const double change = double(world.object(0).velocities()[0].y) + 3;
      expect_bounce(sum, change, 0.01, e, words(e, substeps));
      EXPECT_NEAR(change, 3 * (1 + double(e)), 0.03);
      EXPECT_GT(sum.push.y, 0);
      if (e > 0) {
        EXPECT_EQ(sum.changes, (std::vector<Change>{Change::begin, Change::end})) << words(e, substeps);
      }
    }
}

TEST(BounceEvents, OfTwoBallsHaveTheChangeOfMomentum) {
  for (const float e : {1.f, 0.5f, 0.f}) {
    Scene scene = weightless(8);
    scene.add(ball({0, 1.5f, 0}, {0, -3, 0}, e));
    scene.add(ball({0, 0, 0}, {}, e));
    World world(scene);
    const Sum sum = events_of(world, 60, ObjectId(0), ObjectId(1));
    const double change = double(world.object(0).velocities()[0].y) + 3;
    expect_bounce(sum, change, 0.01, e, words(e, 8));
    EXPECT_NEAR(change, 1.5 * (1 + double(e)), 0.03);
  }
}

/// Each ball of a row gives the next one all that it has.
TEST(BounceEvents, OfARowOfBallsHaveTheImpulseThatTheyPassOn) {
  Scene scene = weightless(8);
  for (int i = 0; i < 4; ++i) scene.add(ball({i == 0 ? -0.5f : float(i), 0, 0}, {i == 0 ? 3.f : 0.f, 0, 0}, 1));
  World world(scene);
  world.record_contact_events(true);
  std::vector<double> impulses(3, 0);
  for (int frame = 0; frame < 30; ++frame) {
    world.step(dt);
    for (const ContactEvent& event : world.contact_events()) {
      ASSERT_EQ(event.second.slot, event.first.slot + 1);
      impulses[std::size_t(event.first.slot)] += event.impulse;
    }
  }
  for (const double impulse : impulses) EXPECT_NEAR(impulse, 3, 0.03);
}

TEST(BounceEvents, OfABoxThatFallsFlatHaveTheChangeOfMomentum) {
  Scene scene = weightless(8);
  Object box = make_body({{Box{{0.5f, 0.2f, 0.3f}}}}, {.position = {0, 0.7f, 0}, .velocity = {0, -3, 0}, .mass = 2});
  box.restitution = 0.5f;
  scene.add(box);
  scene.add(Collider{});
  World world(scene);
  const Sum sum = events_of(world, 60, ObjectId(0), ColliderId(0));
  const double change = 2 * (double(world.object(0).velocities()[0].y) + 3);
  expect_bounce(sum, change, 0.01, 0.5f, "flat box");
  EXPECT_NEAR(change, 9, 0.3);
}

/// Let go from a metre: a bounce is a contact that begins, with the speeds before and after it.
TEST(BounceEvents, BeginOnceWithEachBounce) {
  Scene scene;
  scene.settings = settings_of(8);
  scene.add(ball({0, 1.5f, 0}, {}, 0.9f));
  scene.add(Collider{});
  World world(scene);
  world.record_contact_events(true);
  int bounces = 0, begins = 0;
  for (int frame = 0; frame < 180; ++frame) {
    const double before = double(world.object(0).velocities()[0].y);
    world.step(dt);
    const double after = double(world.object(0).velocities()[0].y);
    const bool has_bounced = before < 0 && after > 0;
    bounces += has_bounced ? 1 : 0;
    for (const ContactEvent& event : world.contact_events()) {
      if (event.change != Change::begin) continue;
      ++begins;
      EXPECT_TRUE(has_bounced) << frame;
      EXPECT_NEAR(event.impulse, after - before + 9.81 / 60, 0.01 * event.impulse) << frame;
      EXPECT_NEAR(event.position.y, 0, 0.05f) << frame;
    }
  }
  EXPECT_GE(bounces, 3);
  EXPECT_EQ(begins, bounces);
}

/// The joint takes part in the impact. Beside it a free ball bounces in the same substep.
TEST(BounceEvents, OfJointedBodiesHaveTheChangeOfMomentum) {
  for (const float e : {1.f, 0.5f}) {
    Scene scene = weightless(8);
    Object pair;
    for (int i = 0; i < 2; ++i)
      add_body(pair, {{Sphere{0.2f}}},
               {.position = {float(i), 0.7f + 0.3f * float(i), 0}, .velocity = {0, -3, 0}, .mass = 1});
    add_joint(pair, FixedJoint{.a = 0, .b = 1, .anchor = {0.5f, 0.85f, 0}});
    pair.restitution = e;
    scene.add(pair);
    scene.add(ball({5, 1, 0}, {0, -3, 0}, e));
    scene.add(Collider{});
    World world(scene), same(scene);
    const Sum of_pair = events_of(world, 20, ObjectId(0), ColliderId(0));
    const Sum of_ball = events_of(same, 20, ObjectId(1), ColliderId(0));
    const double change = momentum(world, ObjectId(0)).y + 6;
    EXPECT_GT(change, 3);
    EXPECT_NEAR(of_pair.push.y, change, 0.01 * change) << words(e, 8);
    EXPECT_NEAR(of_ball.push.y, 3 * (1 + double(e)), 0.03) << words(e, 8);
    EXPECT_EQ(of_ball.begins(), 1);
  }
}

/// A particle of 2 kg and a body of 1 kg.
TEST(BounceEvents, OfAParticleAndABodyHaveTheChangeOfMomentum) {
  for (const float e : {1.f, 0.5f, 0.f})
    for (const int substeps : {4, 8, 20}) {
      Scene scene = weightless(substeps);
      Object point = chain(2, 0.1f);
      point.constraints.clear();
      point.positions = {{0, 1, 0}};
      point.velocities = {{0, -3, 0}};
      point.masses = {2};
      point.collides = true;
      scene.add(point);
      scene.add(ball({}, {}, e));
      World world(scene);
      const Sum sum = events_of(world, 60, ObjectId(0), ObjectId(1));
      const double change = momentum(world, ObjectId(1)).y;
      EXPECT_NEAR(change, -2 * (1 + double(e)), 0.05) << words(e, substeps);
      expect_bounce(sum, -change, 0.01, e, words(e, substeps));
    }
}

/// A level sheet of cloth falls flat on a box, so that many vertices bounce at a time.
TEST(BounceEvents, OfClothAndABodyHaveTheChangeOfMomentum) {
  for (const float e : {0.8f, 0.4f, 0.f})
    for (const float mass : {1e9f, 0.5f}) {
      Scene scene = weightless(8);
      TriangleMesh mesh = grid_mesh(9, 9, 0.5f, 0.5f);
      for (Vec3f& p : mesh.positions) p.y += 0.4f;
      Object cloth = make_cloth(mesh);
      cloth.velocities.assign(cloth.positions.size(), {0, -3, 0});
      cloth.collides = true;
      cloth.restitution = e;
      scene.add(cloth);
      Object box = make_body({{Box{{1, 0.2f, 1}}}}, {.mass = mass});
      scene.add(box);
      World world(scene);
      const Vec3d before = momentum(world, ObjectId(0));
      const Sum sum = events_of(world, 20, ObjectId(0), ObjectId(1));
      const Vec3d change = momentum(world, ObjectId(0)) - before;
      EXPECT_GT(change.y, 0);
      expect_bounce(sum, change.y, 0.01, e, words(e, 8) + ", box of " + std::to_string(mass));
    }
}

/// Cloth that hardly stretches stops a ball. The corrections that would raise the energy do not become velocity, nor
/// impulses of events.
TEST(BounceEvents, OfABallThatClothStopsHaveTheChangeOfMomentum) {
  Scene scene;
  scene.settings = settings_of(12);
  Object cloth = sheet_at("net", {}, 21, 1);
  for (const int corner : {0, 20, 420, 440}) cloth.pins.push_back({corner, {}});
  cloth.collides = true;
  cloth.static_friction = cloth.kinetic_friction = 0;
  scene.add(cloth);
  scene.add(ball({0, 0.75f, 0}, {0, -2, 0}, 0, 0.5f));
  World world(scene);
  const int frames = 24;
  const Sum sum = events_of(world, frames, ObjectId(0), ObjectId(1));
  const double change = 0.5 * (double(world.object(1).velocities()[0].y) + 2 + 9.81 * frames / 60);
  EXPECT_GT(change, 2);
  EXPECT_NEAR(-sum.push.y, change, 0.02 * change);
}

}  // namespace
}  // namespace pliant
