// Tests that each object is solved by its own sweep: side by side, objects get the bits that each gets alone.
#include <gtest/gtest.h>

#include <cstring>

#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Cloth hung by two corners over a ball and a floor. Each has a different thickness, so that no two are equal.
Object hung_cloth(Sweep sweep, int number) {
  ClothOptions options;
  options.name = sweep_name(sweep);
  options.stretch = Stiffness::compliance(1e-6f);
  Object cloth = make_cloth(grid_mesh(9 + number, 9, 0.8f, 0.8f), options);
  cloth.pins = {{0, {}}, {8 + number, {}}};
  cloth.thickness = 0.002f + 0.001f * static_cast<float>(number);
  cloth.sweep = sweep;
  return cloth;
}

Object ball_of_air(Sweep sweep) {
  ClothOptions options;
  options.name = "ball by " + sweep_name(sweep);
  options.volume = Volume{1.2f, Stiffness::compliance(1e-7f)};
  TriangleMesh mesh = sphere_mesh(1);
  for (Vec3f& p : mesh.positions) p = {0.2f * p.x, 0.3f + 0.2f * p.y, 0.2f * p.z};
  Object ball = make_cloth(mesh, options);
  ball.sweep = sweep;
  return ball;
}

Scene accelerated_scene(const std::vector<Object>& objects, SweepOptions::Acceleration acceleration) {
  Scene scene;
  for (const Object& object : objects) scene.add(object);
  Collider ball, floor;
  ball.shape = Sphere{0.2f};
  ball.position = {0, -0.25f, 0};
  floor.position = {0, -0.3f, 0};
  scene.add(ball);
  scene.add(floor);
  scene.settings.substeps = 4;
  scene.settings.iterations = 4;
  scene.settings.record_multipliers = true;
  scene.settings.sweep_options.acceleration = acceleration;
  scene.settings.sweep_options.plain_iterations = 2;
  return scene;
}

bool equal_bits(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0;
}

void expect_the_same_alone(const std::vector<Object>& objects, SweepOptions::Acceleration acceleration) {
  World together(accelerated_scene(objects, acceleration));
  for (int frame = 0; frame < 20; ++frame) ASSERT_TRUE(together.step(dt).ok());
  for (std::size_t o = 0; o < objects.size(); ++o) {
    SCOPED_TRACE(objects[o].name);
    Object object = objects[o];
    Scene scene = accelerated_scene({}, acceleration);
    scene.settings.sweep = object.sweep;  // the sweep comes from the scene's settings; the object has none
    object.sweep = Sweep::automatic;
    scene.add(object);
    World alone(scene);
    for (int frame = 0; frame < 20; ++frame) alone.step(dt);
    EXPECT_TRUE(equal_bits(together.object(static_cast<int>(o)).positions(), alone.object(0).positions()));
    EXPECT_TRUE(equal_bits(together.object(static_cast<int>(o)).velocities(), alone.object(0).velocities()));
    EXPECT_EQ(together.object(static_cast<int>(o)).multipliers("distance"), alone.object(0).multipliers("distance"));
  }
}

TEST(ObjectSweep, GivesTheBitsOfTheObjectAlone) {
  std::vector<Object> objects;
  for (const NamedSweep& one : sweeps()) {
    objects.push_back(hung_cloth(one.sweep, static_cast<int>(objects.size())));
    objects.push_back(ball_of_air(one.sweep));
  }
  expect_the_same_alone(objects, SweepOptions::Acceleration::none);
}

TEST(ObjectSweep, GivesThemAcceleratedToo) {
  std::vector<Object> objects;
  for (const Sweep sweep : {Sweep::tiled, Sweep::symmetric, Sweep::jacobi, Sweep::chains})
    objects.push_back(hung_cloth(sweep, static_cast<int>(objects.size())));
  expect_the_same_alone(objects, SweepOptions::Acceleration::chebyshev);
}

/// A sheet that falls on itself, in two layers.
Object folded(const std::string& name, const Vec3f& at, Sweep sweep) {
  Object cloth = sheet_at(name, {}, 14, 1);
  for (Vec3f& p : cloth.positions) {
    if (p.z > 0.2f) p = {p.x, p.y + 0.02f, 0.4f - p.z};
    p += at;
  }
  cloth.pins = {{0, {}}};
  cloth.thickness = 0.005f;
  cloth.self_collision = true;
  cloth.collides = false;
  cloth.sweep = sweep;
  return cloth;
}

TEST(ObjectSweep, GivesTheBitsOfTheObjectAloneWhereItsSurfaceTouchesItself) {
  for (const Sweep sweep : {Sweep::chains, Sweep::tiled}) {
    Scene alone;
    alone.settings.substeps = 15;
    alone.add(folded("folded", {}, sweep));
    Scene together = alone;
    together.add(folded("other", {5, 0, 0}, Sweep::multigrid));
    World one(alone), both(together);
    std::int64_t contacts = 0;
    for (int frame = 0; frame < 30; ++frame) {
      contacts += one.step(dt).pairs.contacts;
      both.step(dt);
    }
    EXPECT_GT(contacts, 0) << "or this shows nothing";
    EXPECT_TRUE(equal_bits(one.object(0).positions(), both.object(0).positions())) << sweep_name(sweep);
  }
}

/// The filter's further contacts, where a kinematic collider moves into cloth, are of that cloth alone.
TEST(ObjectSweep, GivesTheBitsOfTheObjectAloneBesideAFastCollider) {
  Scene alone;
  alone.settings.substeps = alone.settings.most_substeps = 15;
  alone.add(folded("folded", {}, Sweep::chains));
  Scene together = alone;
  Object hit = folded("hit", {20, 0, 0}, Sweep::chains);
  hit.collides = true;
  hit.groups = hit.mask = 2;
  together.add(hit);
  MeshCollider block;
  block.name = "block";
  block.mesh = sphere_mesh(2);
  for (Vec3f& p : block.mesh.positions) p = p * 0.2f + Vec3f{20, -3, 0};
  block.motion = straight({0, 30, 0}, 1);
  block.groups = block.mask = 2;
  block.thickness = 0.005f;
  together.add(block);
  World one(alone), both(together);
  for (int frame = 0; frame < 30; ++frame) {
    one.step(dt);
    both.step(dt);
    ASSERT_TRUE(equal_bits(one.object(0).positions(), both.object(0).positions())) << frame;
  }
  EXPECT_GT(both.object(1).positions()[100].y, both.object(0).positions()[100].y + 0.2f) << "or the collider missed it";
}

}  // namespace
}  // namespace pliant
