// Tests contact of cloth with rigid bodies, in both directions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/edit.h"
#include "pliant/joint.h"
#include "pliant/material.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "support/run.h"
#include "world/run_time_support.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;
using testing_support::run;

/// A square sheet of n x n vertices and the given side, level at a height.
Object level_cloth(int n, float side, float height) {
  Object cloth = make_cloth(grid_mesh(n, n, side, side));
  Vec3f centre{};
  for (const Vec3f& p : cloth.positions) centre += p * (1.f / static_cast<float>(cloth.positions.size()));
  for (Vec3f& p : cloth.positions) p = {p.x - centre.x, height, p.z - centre.z};
  cloth.collides = true;
  cloth.thickness = 0.01f;
  return cloth;
}

void pin_border(Object& cloth, float side) {
  for (std::size_t i = 0; i < cloth.positions.size(); ++i)
    if (std::max(std::fabs(cloth.positions[i].x), std::fabs(cloth.positions[i].z)) > 0.499f * side)
      cloth.pins.push_back({static_cast<int>(i), {}});
}

Object body(const SolidShape& shape, const Vec3f& position, float mass) {
  BodyOptions options;
  options.position = position;
  options.mass = mass;
  return make_body({{shape}}, options);
}

/// Cloth between two boxes: its contact is with bodies alone, and counts.
TEST(BodyPoints, AreCountedWhereBodiesSqueezeCloth) {
  Scene scene;
  scene.add(level_cloth(9, 0.4f, 0));
  scene.add(body(Box{{0.5f, 0.1f, 0.5f}}, {0, -0.11f, 0}, INFINITY));
  scene.add(body(Box{{0.15f, 0.1f, 0.15f}}, {0, 0.11f, 0}, 5));
  World world(scene);
  run(world, 30);
  const Report report = world.step(dt);
  EXPECT_GT(report.pairs.contacts, 8);
  EXPECT_GE(report.contacts, report.pairs.contacts);
}

TEST(BodyPoints, EachShapeLiesInAHammock) {
  const std::vector<Vec3f> corners{{.2f, .2f, .2f}, {-.2f, -.2f, .2f}, {-.2f, .2f, -.2f}, {.2f, -.2f, -.2f}};
  const std::vector<SolidShape> shapes{Sphere{.2f},          Capsule{.1f, .1f}, Box{{.15f, .1f, .15f}},
                                       Cylinder{.15f, .15f}, Cone{.2f, .15f},   Hull{corners}};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    Scene scene;
    Object cloth = level_cloth(25, 1.2f, 0);
    pin_border(cloth, 1.2f);
    scene.add(cloth);
    scene.add(body(shapes[i], {0, 0.3f, 0}, 1));
    World world(scene);
    run(world, 120);
    const Vec3f at = world.object(1).positions()[0];
    EXPECT_GT(at.y, -0.4f) << "shape " << i;
    EXPECT_LT(at.y, 0.3f) << "shape " << i;
    EXPECT_LT(std::hypot(at.x, at.z), 0.6f) << "shape " << i;
    float lowest = 0;
    for (const Vec3f& p : world.object(0).positions()) lowest = std::min(lowest, p.y);
    EXPECT_LT(lowest, -0.01f) << "shape " << i << ": the body presses the cloth down";
  }
}

/// Without gravity: a ball flies into free cloth; both together keep their momentum.
TEST(BodyPoints, AFreeSystemKeepsItsMomentum) {
  Scene scene;
  scene.gravity = {};
  scene.add(level_cloth(21, 1, 0));
  Object ball = body(Sphere{.15f}, {0.05f, 0.4f, 0}, 0.2f);
  ball.velocities = {{0, -3, 0}};
  scene.add(ball);
  World world(scene);
  const auto momentum = [&] {
    Vec3d sum{};
    const State& state = world.state();
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
      if (!(state.positions[i].w > 0)) continue;
      const double mass = 1 / static_cast<double>(state.positions[i].w);
      const Record& v = state.velocities[i];
      sum += Vec3d{v.x, v.y, v.z} * mass;
    }
    return sum;
  };
  const Vec3d before = momentum();
  run(world, 60);
  const Vec3d after = momentum();
  EXPECT_GT(world.object(1).velocities()[0].y, -2.9f) << "the cloth slows the ball";
  EXPECT_NEAR(length_squared(after - before), 0, 1e-10 * length_squared(before));
}

/// rigid.md: no speed above 3 m/s out of resting contact.
TEST(BodyPoints, ALightBallUnderHeavyClothStaysCalm) {
  for (const float mass : {1.f, 0.1f, 0.01f}) {
    Scene scene;
    scene.colliders.emplace_back();
    scene.add(level_cloth(33, 1.5f, 0.5f));
    scene.add(body(Sphere{.1f}, {0, 0.1f, 0}, mass));
    World world(scene);
    float fastest = 0;
    for (int frame = 0; frame < 120; ++frame) {
      ASSERT_TRUE(world.step(dt).ok());
      fastest = std::max(fastest, std::sqrt(length_squared(world.object(1).velocities()[0])));
    }
    EXPECT_LT(fastest, 3.f) << mass;
    EXPECT_GT(world.object(1).positions()[0].y, 0.05f) << mass;
  }
}

/// What is not solved in an impact may not come back as more energy than there was.
TEST(BodyPoints, ABallOnClothBouncesLessEachTime) {
  Scene scene;
  Object cloth = level_cloth(41, 1.2f, 0);
  pin_border(cloth, 1.2f);
  scene.add(cloth);
  scene.add(body(Sphere{.15f}, {-0.1f, 0.35f, 0.05f}, 1));
  World world(scene);
  float highest = 0, later = 0;
  for (int frame = 0; frame < 180; ++frame) {
    ASSERT_TRUE(world.step(dt).ok());
    const float y = world.object(1).positions()[0].y;
    if (frame > 20) highest = std::max(highest, y);
    if (frame > 90) later = std::max(later, y);
  }
  EXPECT_LT(highest, 0.33f);
  EXPECT_LT(later, 0.26f);
}

/// A sheet that cannot stretch, with 7 % of slack inside its pinned border.
Object slack_sheet(int n, float side) {
  ClothOptions options;
  options.stretch = Stiffness{};
  Object cloth = make_cloth(grid_mesh(n, n, side, side), options);
  Vec3f centre{};
  for (const Vec3f& p : cloth.positions) centre += p * (1.f / static_cast<float>(cloth.positions.size()));
  for (Vec3f& p : cloth.positions) p = {0.93f * (p.x - centre.x), 0, 0.93f * (p.z - centre.z)};
  cloth.collides = true;
  cloth.thickness = 0.01f;
  pin_border(cloth, 0.93f * side);
  return cloth;
}

/// An inextensible sheet stores no energy, so the impact is plastic: the ball does not rise above its place of rest by
/// a tenth of its fall.
TEST(BodyPoints, AHeavyBallDoesNotBounceOnAnInextensibleSheet) {
  for (const float mass : {1.f, 20.f}) {
    Scene scene;
    scene.add(slack_sheet(31, 1.2f));
    constexpr float start = 0.6f;
    scene.add(body(Sphere{.15f}, {0.02f, start, 0.01f}, mass));
    World world(scene);
    std::vector<float> heights;
    float lowest = start, highest = -1;  // the highest after the lowest
    for (int frame = 0; frame < 180; ++frame) {
      ASSERT_TRUE(world.step(dt).ok());
      heights.push_back(world.object(1).positions()[0].y);
      if (heights.back() < lowest) highest = lowest = heights.back();
      highest = std::max(highest, heights.back());
    }
    const float rest = heights.back();
    EXPECT_LT(rest, 0.15f) << mass;
    EXPECT_GT(rest, -0.3f) << mass;
    EXPECT_LT(highest - rest, 0.1f * (start - rest)) << mass;
    const auto [low, high] = std::minmax_element(heights.end() - 30, heights.end());
    EXPECT_LT(*high - *low, 0.01f) << mass << ": it rests";
  }
}

/// The rope carries the body's inertia where it is tied, so 4 000 times the weight of a particle does not stretch it by
/// 1 %.
TEST(BodyPoints, ARopeHoldsAHeavyBody) {
  constexpr int points = 41;
  std::vector<Vec3f> line;
  for (int i = 0; i < points; ++i) line.push_back({0.02f * static_cast<float>(i), 1, 0});
  RopeOptions options;
  options.linear_density = 0.125f;  // 2.5 g a particle
  Object object = body(Box{{.05f, .05f, .05f}}, {0.85f, 1, 0}, 10);
  const int first = append(object, make_rope(line, options));
  object.pins.push_back({first, {}});
  attach(object, {first + points - 1}, 0);
  Scene scene;
  scene.add(object);
  World world(scene);
  float longest = 0;
  for (int frame = 0; frame < 240; ++frame) {  // it swings from level
    ASSERT_TRUE(world.step(dt).ok());
    const auto at = world.object(0).positions();
    float length = 0;
    for (int i = 1; i < points; ++i) length += std::sqrt(length_squared(at[first + i] - at[first + i - 1]));
    longest = std::max(longest, length);
  }
  EXPECT_LT(longest, 1.01f * 0.8f);
}

/// A ball of 5 cm flies at 30 m/s against coarse cloth (cells of 10 cm). Returns true if it ends on the other side.
bool passes(const Vec3f& place, const Vec3f& direction, int substeps) {
  Scene scene;
  scene.gravity = {};
  scene.settings.substeps = substeps;
  Object cloth = level_cloth(13, 1.2f, 0);
  pin_border(cloth, 1.2f);
  scene.add(cloth);
  Object ball = body(Sphere{.025f}, place - direction * 0.4f, 0.01f);
  ball.velocities = {direction * 30.f};
  scene.add(ball);
  World world(scene);
  run(world, 4);
  const float side = direction.y < 0 ? -1.f : 1.f, end = side * world.object(1).positions()[0].y;
  float farthest = 0;
  for (const Vec3f& p : world.object(0).positions()) farthest = std::max(farthest, side * p.y);
  return !(end < farthest + 0.03f);
}

/// On a face, an edge, a vertex and between, from above, below and aslant. In 4 substeps a frame it moves by 12.5 cm in
/// each.
TEST(BodyPoints, AFastSmallBallDoesNotPassCoarseCloth) {
  const Vec3f places[] = {{0.03f, 0, 0.06f}, {0.05f, 0, 0.05f}, {0.05f, 0, 0},
                          {0, 0, 0.05f},     {0, 0, 0},         {0.01f, 0, 0.02f}};
  const Vec3f directions[] = {{0, -1, 0}, {0, 1, 0}, {0.6f, -0.8f, 0}, {0, 0.8f, 0.6f}, {0.48f, -0.6f, 0.64f}};
  for (const int substeps : {0, 8, 4})
    for (std::size_t d = 0; d < std::size(directions); ++d)
      for (std::size_t p = 0; p < std::size(places); ++p)
        EXPECT_FALSE(passes(places[p], directions[d], substeps))
            << "place " << p << ", direction " << d << ", " << substeps << " substeps";
}

/// What pressed on a particle at a frame's end is not in the State, so the next frame may not know it.
TEST(BodyPoints, AHeavyBallOnClothGoesOnWithTheSameBitsAfterARestore) {
  Scene scene;
  Object cloth = level_cloth(13, 1.2f, 0);
  pin_border(cloth, 1.2f);
  scene.add(cloth);
  scene.add(body(Sphere{.1f}, {0, 0.15f, 0}, 20));
  World world(scene);
  run(world, 30);
  World other(scene);
  other.restore(world.state());
  run(world, 10);
  run(other, 10);
  EXPECT_EQ(world.state_hash(), other.state_hash());
}

TEST(BodyPoints, HasTheSameBitsOnAnyNumberOfThreads) {
  std::string hashes[2];
  for (int i = 0; i < 2; ++i) {
    Scene scene;
    scene.settings.threads = i + 1;
    Object cloth = level_cloth(41, 1.2f, 0);
    pin_border(cloth, 1.2f);
    scene.add(cloth);
    Object pile = body(Sphere{.1f}, {0, 0.2f, 0}, 0.5f);
    BodyOptions options;
    for (int b = 0; b < 6; ++b) {
      options.position = {0.2f * static_cast<float>(b % 3) - 0.2f, 0.5f + 0.2f * static_cast<float>(b), 0.05f};
      add_body(pile, {{Box{{0.08f, 0.06f, 0.07f}}}}, options);
    }
    scene.add(pile);
    World world(scene);
    run(world, 60);
    hashes[i] = world.state_hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

/// A crate of 0.2 m on cotton on a table.
Scene crate_on_cotton(bool is_mesh, float friction, float mass) {
  Scene scene;
  ClothOptions options;
  options.material = fabric("cotton");
  Object cloth = make_cloth(grid_mesh(9, 9, 0.5f, 0.5f), options);
  for (Vec3f& p : cloth.positions) p.y = 0.005f;
  cloth.thickness = 0.003f;
  cloth.self_collision = cloth.collides = true;
  Object crate = body(Box{{0.1f, 0.1f, 0.1f}}, {0, 0.11f, 0}, mass),
         table = body(Box{{1, 0.1f, 1}}, {0, -0.1f, 0}, INFINITY);
  for (Object* object : {&cloth, &crate, &table}) object->static_friction = object->kinetic_friction = friction;
  scene.add(crate);
  scene.add(cloth);
  if (!is_mesh) scene.add(table);
  if (!is_mesh) return scene;
  MeshCollider mesh;
  mesh.mesh = testing_support::box_mesh({2, 0.2f, 2});
  for (Vec3f& p : mesh.mesh.positions) p.y -= 0.1f;
  mesh.static_friction = mesh.kinetic_friction = friction;
  scene.add(mesh);
  return scene;
}

/// The fastest of a frame in the second second [m/s].
float creep(const Scene& scene) {
  World world(scene);
  run(world, 60);
  float fastest = 0;
  Vec3f last = world.object(0).positions()[0];
  for (int frame = 0; frame < 30; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    const Vec3f now = world.object(0).positions()[0];
    fastest = std::max(fastest, std::hypot(now.x - last.x, now.z - last.z) / dt);
    last = now;
  }
  return fastest;
}

/// Friction holds, and on level ground nothing drives. The crate has 8 500 and 85 000 masses of an inner particle.
TEST(BodyPoints, ACrateOnATableClothLiesStill) {
  for (const bool is_mesh : {false, true})
    for (const float friction : {0.4f, 0.8f})
      for (const float mass : {4.f, 40.f})
        EXPECT_LT(creep(crate_on_cotton(is_mesh, friction, mass)), 0.001f)
            << (is_mesh ? "mesh" : "body") << ", friction " << friction << ", " << mass << " kg";
}

/// A strip of cotton that hangs by its upper end, and two fingers of 50 g on sliders that close with a force [N].
Scene fingers_about_cotton(float grip, std::vector<int>& top) {
  Scene scene;
  ClothOptions options;
  options.material = fabric("cotton");
  Object cloth = make_cloth(grid_mesh(9, 17, 0.1f, 0.2f), options);
  const Vec3f first = cloth.positions.front(), last = cloth.positions.back();
  for (Vec3f& p : cloth.positions) p = {p.x - (first.x + last.x) / 2, p.z - (first.z + last.z) / 2, 0};
  for (int i = 0; i < static_cast<int>(cloth.positions.size()); ++i)
    if (cloth.positions[static_cast<std::size_t>(i)].y > 0.0999f) top.push_back(i);
  for (const int i : top) cloth.pins.push_back({i, {}});
  cloth.collides = true;
  Object gripper;
  BodyOptions hand;
  hand.kinematic = true;
  hand.position = {0.3f, 0.05f, 0};
  add_body(gripper, {{Sphere{0.005f}}}, hand);
  for (const float side : {-1.f, 1.f}) {
    BodyOptions finger;
    finger.mass = 0.05f;
    finger.position = {0, 0.05f, 0.03f * side};
    SliderJoint slider;
    slider.a = 0;
    slider.b = add_body(gripper, {{Box{{0.02f, 0.015f, 0.005f}}}}, finger);
    slider.anchor = finger.position;
    slider.axis = {0, 0, 1};
    slider.motor = JointMotor{.target = -0.05f * side, .most = grip};
    add_joint(gripper, slider);
  }
  for (Object* object : {&cloth, &gripper}) object->static_friction = object->kinetic_friction = 0.8f;
  scene.add(cloth);
  scene.add(gripper);
  return scene;
}

/// The fingers bear their own weight and that of the strip, and nothing drives them aside.
TEST(BodyPoints, FingersBearTheClothThatTheyGrip) {
  std::vector<int> top;
  const Scene scene = fingers_about_cotton(3, top);
  World world(scene);
  world.record_joint_loads(true);
  run(world, 60);
  Edit edit = unchanged(scene.objects[0]);
  edit.object.pins.clear();
  world.edit(0, edit);
  run(world, 60);
  Vec3f sum{};
  for (int frame = 0; frame < 30; ++frame) {
    ASSERT_TRUE(world.step(dt).ok());
    for (const int joint : {0, 1}) sum += world.object(1).mean_joint_load(joint).force * (1.f / 30);
  }
  const float weight = 9.81f * (0.1f + 0.02f * fabric("cotton").area_density);
  EXPECT_NEAR(sum.y, weight, 0.02f * weight);
  EXPECT_NEAR(sum.x, 0, 0.03f);
  EXPECT_NEAR(sum.z, 0, 0.03f);
}

}  // namespace
}  // namespace pliant
