// Tests that what is far away changes no bit of an object, and that what comes near is met.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/liquid.h"
#include "pliant/soft_body.h"
#include "world/substep_groups_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float far = 50;  // [m]

Object moved(Object object, const Vec3f& by) {
  for (Vec3f& p : object.positions) p += by;
  return object;
}

/// Cloth that hangs by two corners, and can meet all but itself.
Object curtain() {
  ClothOptions options;
  options.material = fabric("cotton");
  Object cloth = sheet_at("curtain", {0, 1, 0}, 9, 1, options);
  cloth.pins = {{0, {}}, {8, {}}};
  cloth.thickness = 0.005f;
  cloth.collides = true;
  cloth.sweep = Sweep::chains;
  return cloth;
}

Object tangled() {
  Object cloth = sock();
  cloth.name = "tangled";
  cloth.collides = true;
  return moved(cloth, {0, 0.7f, -3});
}

Object cord() {
  std::vector<Vec3f> points;
  for (int i = 0; i < 40; ++i) points.push_back({0.03f * static_cast<float>(i), 1, 0});
  Object rope = make_rope(points);
  rope.name = "cord";
  rope.pins = {{0, {}}};
  rope.collides = true;
  rope.sweep = Sweep::chains;
  return rope;
}

Object jelly() {
  SoftBodyOptions options;
  options.name = "jelly";
  options.material.youngs_modulus = 2e4f;
  Object body = make_soft_body(box_tetrahedra({0.3f, 0.3f, 0.3f}, {3, 3, 3}), options);
  body.self_collision = true;
  return moved(body, {0, 0.3f, 0});
}

Object honey() {
  LiquidOptions options;
  options.name = "honey";
  options.fluid.spacing = 0.05f;
  options.fluid.viscosity = 10;  // solved by conjugate gradients, whose sums are over a pool
  options.fluid.surface_tension = 0.07f;
  return make_liquid(fill_box({0, 0, 0}, {0.3f, 0.4f, 0.3f}, 0.05f), options);
}

Object crate() {
  BodyOptions options;
  options.name = "crate";
  options.position = {0, 0.3f, 0};
  options.angular_velocity = {1, 2, 3};
  return make_body({{Box{{0.2f, 0.2f, 0.2f}}}}, options);
}

std::vector<Object> one_of_each_kind() { return {curtain(), tangled(), cord(), jelly(), honey(), crate()}; }

Scene over_a_floor(const std::vector<Object>& objects) {
  Scene scene;
  scene.add(floor_at(0));
  for (const Object& object : objects) scene.add(object);
  return scene;
}

/// Runs a scene without and with something 50 m away, and expects the same bits of its object.
void expect_as_alone(const Object& one, const Object& other, int substeps) {
  Scene alone = over_a_floor({one}), together = over_a_floor({one, moved(other, {far, 0, 0})});
  alone.settings.substeps = together.settings.substeps = substeps;
  World first(alone), second(together);
  for (int frame = 0; frame < 12; ++frame) {
    ASSERT_TRUE(first.step(dt).ok());
    ASSERT_TRUE(second.step(dt).ok());
  }
  expect_the_same(second, 0, first, 0);
}

TEST(FarObjects, OfAnyKindChangeNoBit) {
  const std::vector<Object> kinds = one_of_each_kind();
  for (const Object& one : kinds)
    for (const Object& other : kinds) {
      SCOPED_TRACE("'" + one.name + "' beside '" + other.name + "'");
      expect_as_alone(one, other, 0);
    }
}

/// With a number of substeps for all, contact is searched and filtered for all together.
TEST(FarObjects, ChangeNoBitWhereAllHaveTheSameSubsteps) {
  for (const Object& one : {tangled(), jelly()})
    for (const Object& other : {tangled(), jelly()}) {
      SCOPED_TRACE("'" + one.name + "' beside '" + other.name + "'");
      Object fast = other;
      fast.velocities.assign(fast.positions.size(), Vec3f{9, 3, 0});  // it flies away
      expect_as_alone(one, fast, 16);
    }
}

TEST(FarObjects, MayBeMeshColliders) {
  Scene scene = over_a_floor({curtain()});
  World alone(scene);
  MeshCollider ball;
  ball.name = "ball";
  ball.mesh = sphere_mesh(2);
  for (Vec3f& p : ball.mesh.positions) p = 0.3f * p + Vec3f{far, 1, 0};
  ball.motion = straight({2, 0, 0}, 1);
  scene.add(ball);
  World together(scene);
  run(alone, 20);
  run(together, 20);
  expect_the_same(together, 0, alone, 0);
}

/// The case of a report: a box 50 m away made 40 substeps of 10.5.
TEST(FarObjects, LeaveAnObjectTheSubstepsThatFollowItsState) {
  World near(over_a_floor({curtain(), moved(crate(), {0.5f, 0, 0})}));
  World apart(over_a_floor({curtain(), moved(crate(), {far, 0, 0})}));
  EXPECT_EQ(near.object(0).info().substeps, 40);
  EXPECT_EQ(apart.object(0).info().substeps, 0) << "they follow the State";
  EXPECT_EQ(apart.object(1).info().substeps, 8);
}

/// A taut sheet across the path of a ball that comes from 50 m away.
Scene shot_at_sheet(float speed) {
  ClothOptions options;
  options.material = fabric("cotton");
  Object net = sheet_at("net", {0, 0, 0}, 13, 1, options);
  for (Vec3f& p : net.positions) p = {0, p.x, p.z};
  for (const int corner : {0, 12, 156, 168}) net.pins.push_back({corner, {}});
  net.thickness = 0.01f;
  net.collides = true;
  BodyOptions ball;
  ball.name = "ball";
  ball.position = {-far, 0.02f, 0.03f};
  ball.velocity = {speed, 0, 0};
  ball.mass = 0.02f;
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.add(net);
  scene.add(make_body({{Sphere{0.12f}}}, ball));
  return scene;
}

TEST(FarObjects, ThatFlyInAreMet) {
  for (const float speed : {20.f, 60.f, 100.f}) {
    World world(shot_at_sheet(speed));
    const int frames = static_cast<int>(far / speed * 60) + 20;
    float most = 0;
    for (int frame = 0; frame < frames; ++frame) {
      ASSERT_TRUE(world.step(dt).ok());
      for (const Vec3f& p : world.object(0).positions()) most = std::max(most, p.x);
      const float ball = world.object(1).positions()[0].x;
      ASSERT_LT(ball, std::max(most, 0.f)) << speed << " m/s, frame " << frame << ": through";
    }
    EXPECT_GT(most, 0.05f) << speed << " m/s: it never met the sheet";
    EXPECT_LT(world.object(1).velocities()[0].x, 0.5f * speed);
  }
}

/// Sets follow from the State: it goes on with the same bits wherever it is restored, by any number of threads.
TEST(FarObjects, ThatComeNearDoSoWithTheSameBits) {
  Scene scene = shot_at_sheet(60);
  World world(scene);
  std::vector<State> saved;
  std::vector<int> substeps;
  for (int frame = 0; frame < 60; ++frame) {
    if (frame % 4 == 0 && frame >= 36) saved.push_back(world.state());
    world.step(dt);
    substeps.push_back(world.object(0).info().substeps);
  }
  EXPECT_EQ(substeps.front(), 0);
  EXPECT_EQ(substeps[49], 40);
  for (const State& state : saved) {
    scene.settings.threads = 1 + static_cast<int>(state.frame / 4 % 3);
    World other(scene);
    other.restore(state);
    while (other.state().frame < 60) other.step(dt);
    EXPECT_EQ(other.state_hash(), world.state_hash()) << "from frame " << state.frame;
  }
}

/// Two that come near meet as they do where they began near: the search of contact takes up what joins.
TEST(FarObjects, OfOneGroupThatComeNearHaveContact) {
  Object left = moved(jelly(), {-3, 0, 0}), right = moved(jelly(), {3, 0, 0});
  left.velocities.assign(left.positions.size(), Vec3f{5, 0, 0});
  right.velocities.assign(right.positions.size(), Vec3f{-5, 0, 0});
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.add(left);
  scene.add(right);
  World world(scene);
  std::int64_t contacts = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const Report report = world.step(dt);
    ASSERT_TRUE(report.ok());
    contacts += report.pairs.contacts;
  }
  EXPECT_GT(contacts, 0);
  const auto mean = [&](int o) {
    float sum = 0;
    for (const Vec3f& p : world.object(o).positions()) sum += p.x;
    return sum / static_cast<float>(world.object(o).positions().size());
  };
  EXPECT_LT(mean(0), mean(1)) << "they have passed through each other";
}

/// What a force field moves may be anywhere at the end of a frame, so such scenes are not divided.
TEST(FarObjects, DoNotPassOneAnotherInABlast) {
  Object left = moved(jelly(), {0, 0.5f, 0}), right = moved(jelly(), {1.2f, 0.5f, 0});
  for (Object* cube : {&left, &right}) cube->collides = true;
  Scene scene = over_a_floor({left, right});
  const auto blast = [](const Vec3f& p, const Vec3f&, float mass, float time) {
    return p.x < 0.5f && time < 0.016f ? Vec3f{4000 * mass, 0, 0} : Vec3f{};
  };
  scene.forces.emplace_back(blast);
  World world(scene);
  const auto middle = [&](int o) {
    float sum = 0;
    for (const Vec3f& p : world.object(o).positions()) sum += p.x;
    return sum / static_cast<float>(world.object(o).positions().size());
  };
  for (int frame = 0; frame < 3; ++frame) {
    world.step(dt);
    ASSERT_LT(middle(0), middle(1)) << "frame " << frame;
  }
}

}  // namespace
}  // namespace pliant
