// Tests contact of rigid bodies in a World: with one another and with colliders.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "support/run.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;
using testing_support::fastest;
using testing_support::run;

Scene with_ground() {
  Scene scene;
  scene.colliders.emplace_back();
  scene.colliders.back().static_friction = scene.colliders.back().kinetic_friction = 0.6f;
  return scene;
}

void set_friction(Object& object, float friction) { object.static_friction = object.kinetic_friction = friction; }

Object pyramid(int base) {
  Object pile;
  pile.name = "pyramid";
  for (int row = 0; row < base; ++row)
    for (int i = 0; i < base - row; ++i) {
      BodyOptions options;
      options.position = {static_cast<float>(i) + 0.5f * static_cast<float>(row), 0.5f + static_cast<float>(row), 0};
      add_body(pile, {{Box{}}}, options);
    }
  set_friction(pile, 0.6f);
  return pile;
}

TEST(BodyContact, ABoxFallsOnAPlaneAndRests) {
  Scene scene = with_ground();
  BodyOptions options;
  options.position = {0, 1, 0};
  scene.add(make_body({{Box{}}}, options));
  World world(scene);
  run(world, 120);
  EXPECT_NEAR(world.object(0).positions()[0].y, 0.5, 1e-3);
  EXPECT_LT(fastest(world), 1e-4f);
  ASSERT_EQ(world.state().body_contacts.size(), 1U);
  EXPECT_EQ(world.state().body_contacts[0].count, 4);
  const double substep = 1. / 60 / 8;  // four impulses bear the weight
  double sum = 0;
  for (const float impulse : world.state().body_contacts[0].impulse) sum += static_cast<double>(impulse);
  EXPECT_NEAR(sum / (1000 * 9.81 * substep), 1, 1e-3);
}

TEST(BodyContact, EachShapeRestsOnEachCollider) {
  const std::vector<Vec3f> corners{{.3f, .3f, .3f}, {-.3f, -.3f, .3f}, {-.3f, .3f, -.3f}, {.3f, -.3f, -.3f}};
  const std::vector<SolidShape> shapes{Sphere{.3f},        Capsule{.2f, .2f}, Box{{.3f, .2f, .2f}},
                                       Cylinder{.3f, .2f}, Cone{.3f, .3f},    Hull{corners}};
  const std::vector<Shape> colliders{Plane{}, Box{{2, 0.5f, 2}}};
  for (const Shape& shape : colliders)
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      Scene scene = with_ground();
      scene.colliders[0].shape = shape;
      if (!std::holds_alternative<Plane>(shape)) scene.colliders[0].position = {0, -0.5f, 0};
      BodyOptions options;
      options.position = {0, 0.6f, 0};
      options.rotation = {0.1f, 0, 0.05f, 0.9937f};
      Object body = make_body({{shapes[i]}}, options);
      set_friction(body, 0.6f);
      scene.add(body);
      World world(scene);
      run(world, 480);
      EXPECT_LT(fastest(world), 0.02f) << "shape " << i;
      EXPECT_GT(world.object(0).positions()[0].y, 0.1f) << "shape " << i;
      EXPECT_LT(world.object(0).positions()[0].y, 0.4f) << "shape " << i;
    }
}

/// rigid.md: 0.011 m at 8 substeps.
TEST(BodyContact, APyramidOf30RowsStands) {
  Scene scene = with_ground();
  scene.add(pyramid(30));
  World world(scene);
  const std::vector<Vec3f> start = world.object(0).positions();
  run(world, 240);
  const std::vector<Vec3f> end = world.object(0).positions();
  float farthest = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    farthest = std::max(farthest, std::sqrt(length_squared(end[i] - start[i])));
  EXPECT_LT(farthest, 0.015f);
  EXPECT_LT(fastest(world), 1e-2f);
}

TEST(BodyContact, HasTheSameBitsOnAnyNumberOfThreadsAndAfterRestore) {
  Scene scene = with_ground();
  scene.add(pyramid(12));
  BodyOptions options;
  options.position = {6, 14, 0.2f};
  options.velocity = {0, -8, 0};
  scene.add(make_body({{Sphere{0.8f}}}, options));
  std::string hashes[2];
  for (int i = 0; i < 2; ++i) {
    scene.settings.threads = i + 1;
    World world(scene);
    run(world, 60);
    hashes[i] = world.state_hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  World world(scene), other(scene);
  run(world, 30);
  other.restore(world.state());
  run(other, 30);
  EXPECT_EQ(other.state_hash(), hashes[0]);
}

/// Friction of 0.6 holds at a slope of tan 0.5 and not at tan 0.7.
TEST(BodyContact, ABoxStaysOnASlopeUpToItsFriction) {
  for (const double slope : {0.5, 0.7}) {
    Scene scene = with_ground();
    const auto half = static_cast<float>(std::atan(slope) / 2);
    scene.colliders[0].rotation = {0, 0, std::sin(half), std::cos(half)};
    BodyOptions options;
    options.rotation = scene.colliders[0].rotation;
    options.position = {-0.5f * std::sin(2 * half), 0.5f * std::cos(2 * half), 0};
    Object box = make_body({{Box{}}}, options);
    set_friction(box, 0.6f);
    scene.add(box);
    World world(scene);
    run(world, 60);
    const Vec3f moved = world.object(0).positions()[0] - options.position;
    const double angle = std::atan(slope), expected = 0.5 * 9.81 * (std::sin(angle) - 0.6 * std::cos(angle));
    EXPECT_NEAR(static_cast<double>(std::sqrt(length_squared(moved))), std::max(expected, 0.), 0.02) << slope;
  }
}

TEST(BodyContact, ABallBouncesToTheSquareOfItsRestitution) {
  Scene scene = with_ground();
  BodyOptions options;
  options.position = {0, 2.1f, 0};
  Object ball = make_body({{Sphere{0.1f}}}, options);
  ball.restitution = 0.8f;
  scene.add(ball);
  World world(scene);
  float highest = 0;
  for (int frame = 0; frame < 100; ++frame) {
    ASSERT_TRUE(world.step(dt).ok());
    if (frame > 45) highest = std::max(highest, world.object(0).positions()[0].y - 0.1f);
  }
  EXPECT_NEAR(highest, 2 * 0.64, 0.04);
}

TEST(BodyContact, AMovingColliderCarriesABox) {
  Scene scene = with_ground();
  scene.colliders[0].shape = Box{{2, 0.1f, 2}};
  scene.colliders[0].motion.keyframes = {{0, {}, {}}, {1, {}, {}}, {3, {1, 0.5f, 0}, {}}};
  BodyOptions options;
  options.position = {0, 0.6f, 0};
  scene.add(make_body({{Box{}}}, options));
  World world(scene);
  run(world, 240);
  EXPECT_NEAR(world.object(0).positions()[0].x, 1, 0.04);
  EXPECT_NEAR(world.object(0).positions()[0].y, 1.1, 2e-3);
}

TEST(BodyContact, OfARemovedObjectOrColliderIsForgotten) {
  Scene scene = with_ground();
  BodyOptions options;
  options.position = {0, 0.5f, 0};
  scene.add(make_body({{Box{}}}, options));
  options.position = {0, 1.5f, 0};
  scene.add(make_body({{Box{}}}, options));
  World world(scene);
  run(world, 30);
  EXPECT_EQ(world.state().body_contacts.size(), 2U);
  world.remove(ObjectId(0));
  EXPECT_EQ(world.state().body_contacts.size(), 0U);
  run(world, 60);
  EXPECT_NEAR(world.object(1).positions()[0].y, 0.5, 1e-3);
  world.remove(ColliderId(0));
  EXPECT_EQ(world.state().body_contacts.size(), 0U);
  run(world, 30);
  EXPECT_LT(world.object(1).positions()[0].y, -0.5f);
}

/// Friction of 0.3 holds up to 16.7 degrees also where the box has lain still on what turns.
TEST(BodyContact, ABoxSlidesOffAPlateThatTilts) {
  Scene scene = with_ground();
  scene.colliders[0].shape = Box{{3, 0.1f, 3}};
  scene.colliders[0].motion.keyframes = {{0, {}, {}}, {1, {}, {}}, {4, {}, rotation({0, 0, 1}, 30)}};
  scene.colliders[0].motion.pivot = {};
  BodyOptions options;
  options.position = {0, 0.301f, 0};
  Object box = make_body({{Box{{0.2f, 0.2f, 0.2f}}}}, options);
  set_friction(box, 0.15f);  // the plate has 0.6
  scene.add(box);
  World world(scene);
  run(world, 60 + 84);  // 14 degrees
  EXPECT_NEAR(world.object(0).positions()[0].x, 0, 0.12);
  run(world, 66);  // 25 degrees: -0.13 without sliding
  EXPECT_LT(world.object(0).positions()[0].x, -0.22f);
}

/// A mesh whose vertices the user moves carries what lies on it, also after the State is restored.
TEST(BodyContact, AMeshThatTheUserMovesCarriesABox) {
  Scene scene;
  MeshCollider floor;
  floor.mesh = grid_mesh(3, 3, 4, 4);
  const std::vector<Vec3f> rest = floor.mesh.positions;
  scene.add(floor);
  BodyOptions options;
  options.position = {0.1f, 0.1f, 0.1f};
  scene.add(make_body({{Box{{0.1f, 0.1f, 0.1f}}}}, options));
  World world(scene);
  run(world, 30);
  for (int frame = 0; frame < 60; ++frame) {
    std::vector<Vec3f> moved = rest;
    for (Vec3f& p : moved) p.y += 0.2f * static_cast<float>(frame + 1) / 60;
    world.mesh_collider(0).set_positions(moved);
    run(world, 1);
  }
  EXPECT_NEAR(world.object(0).positions()[0].y, 0.3, 0.02);
  World other(scene);
  other.restore(world.state());
  run(world, 30);
  run(other, 30);
  EXPECT_EQ(world.state_hash(), other.state_hash());
  EXPECT_NEAR(other.object(0).positions()[0].y, 0.3, 0.01);
}

/// 5 000 bodies in one place come apart, and the Report says that not all touch at once.
TEST(BodyContact, BodiesInOnePlaceSeparate) {
  Scene scene;
  scene.gravity = {};
  Object pile;
  const int count = 5000;
  for (int i = 0; i < count; ++i) add_body(pile, {{Sphere{0.1f}}});
  scene.add(pile);
  World world(scene);
  const Report first = world.step(dt);
  ASSERT_TRUE(first.ok());
  ASSERT_FALSE(first.warnings.empty());
  EXPECT_NE(first.warnings[0].find("left to later frames"), std::string::npos) << first.warnings[0];
  run(world, 11);
  const std::vector<Vec3f> at = world.object(0).positions();
  float farthest = 0;
  for (const Vec3f& p : at) farthest = std::max(farthest, std::sqrt(length_squared(p)));
  EXPECT_GT(farthest, 0.1f);
  EXPECT_LT(farthest, 30.f);
}

TEST(BodyContact, EventsNameBothAndTheImpulseOfAStep) {
  Scene scene = with_ground();
  BodyOptions options;
  options.position = {0, 0.5f, 0};
  scene.add(make_body({{Box{}}}, options));
  options.position = {0, 1.5f, 0};
  scene.add(make_body({{Box{}}}, options));
  World world(scene);
  run(world, 60);
  world.record_contact_events(true);
  run(world, 1);
  const std::vector<ContactEvent>& events = world.contact_events();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].first, Thing(ObjectId(0)));
  EXPECT_EQ(events[0].second, Thing(ObjectId(1)));
  EXPECT_NEAR(events[0].impulse, 1000 * 9.81 / 60, 1);
  EXPECT_LT(events[0].normal.y, -0.99f) << "the upper box pushes the lower one down";
  EXPECT_NEAR(events[0].position.y, 1, 0.01);
  EXPECT_EQ(events[1].second, Thing(ColliderId(0)));
  EXPECT_NEAR(events[1].impulse, 2000 * 9.81 / 60, 2);
}

/// A bowl of flat sides; its lowest point is at the origin.
MeshCollider bowl(MeshCollider::As as) {
  MeshCollider collider;
  collider.name = "bowl";
  collider.as = as;
  const int n = 16;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const float z = 4.f * static_cast<float>(i) / n - 2, x = 4.f * static_cast<float>(j) / n - 2;
      collider.mesh.positions.push_back({x, 0.25f * (x * x + z * z), z});
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      collider.mesh.triangles.push_back({a, b, a + 1});
      collider.mesh.triangles.push_back({a + 1, b, b + 1});
    }
  return collider;
}

TEST(BodyContact, BodiesStayInABowlThatIsAMeshOrAHeightfield) {
  for (const MeshCollider::As as : {MeshCollider::As::triangles, MeshCollider::As::heightfield}) {
    Scene scene;
    scene.add(bowl(as));
    Object pile;
    const std::vector<SolidShape> shapes{Sphere{.15f}, Capsule{.1f, .1f}, Box{{.15f, .1f, .1f}}, Cylinder{.15f, .1f}};
    for (int i = 0; i < 16; ++i) {
      BodyOptions options;
      options.position = {0.7f * static_cast<float>(i % 2) - 0.35f, 1 + 0.4f * static_cast<float>(i / 2),
                          0.1f * static_cast<float>(i % 3)};
      add_body(pile, {{shapes[static_cast<std::size_t>(i % 4)]}}, options);
    }
    scene.add(pile);
    World world(scene);
    run(world, 360);  // a ball that bounces off the others rolls to and fro for five seconds
    for (const Vec3f& p : world.object(0).positions()) {
      EXPECT_GT(p.y - 0.25f * (p.x * p.x + p.z * p.z), 0.05f);
      EXPECT_LT(p.y, 1.5f);
    }
    EXPECT_LT(fastest(world), 0.5f);
  }
}

TEST(BodyContact, WhatIsPressedIntoSomethingIsNamed) {
  for (const bool is_heavy : {false, true}) {
    Scene scene = with_ground();
    Object pile;
    pile.name = "pile";
    add_body(pile, {{Box{{0.1f, 0.1f, 0.1f}}}}, {.position = {0, 0.1f, 0}, .mass = 1});
    add_body(pile, {{Box{{0.5f, 0.5f, 0.5f}}}}, {.position = {0, 0.7f, 0}, .mass = is_heavy ? 1000.f : 10.f});
    scene.add(pile);
    World world(scene);
    std::string
        warnings;  // sag by the formula on the page: 1.04 h^2 F / m = 0.44 mm under 10 kg, and 44 mm under 1 000 kg
    for (int frame = 0; frame < 30; ++frame)
      for (const std::string& warning : world.step(dt).warnings) warnings += warning + "\n";
    EXPECT_EQ(warnings.empty(), !is_heavy) << warnings;
    EXPECT_EQ(warnings.find("body 0 of 'pile'") != std::string::npos, is_heavy) << warnings;
  }
}

}  // namespace
}  // namespace pliant
