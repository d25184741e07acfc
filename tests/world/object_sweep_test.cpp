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

Scene scene_of(const std::vector<Object>& objects, SweepOptions::Acceleration acceleration) {
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
  World together(scene_of(objects, acceleration));
  for (int frame = 0; frame < 20; ++frame) ASSERT_TRUE(together.step(dt).ok());
  for (std::size_t o = 0; o < objects.size(); ++o) {
    SCOPED_TRACE(objects[o].name);
    Object object = objects[o];
    Scene scene = scene_of({}, acceleration);
    scene.settings.sweep = object.sweep;  // the sweep comes from the scene's settings; the object has none
    object.sweep = Sweep::automatic;
    scene.add(object);
    World alone(scene);
    for (int frame = 0; frame < 20; ++frame) alone.step(dt);
    EXPECT_TRUE(equal_bits(together.positions(static_cast<int>(o)), alone.positions(0)));
    EXPECT_TRUE(equal_bits(together.velocities(static_cast<int>(o)), alone.velocities(0)));
    EXPECT_EQ(together.multipliers(static_cast<int>(o), "distance"), alone.multipliers(0, "distance"));
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

}  // namespace
}  // namespace pliant
