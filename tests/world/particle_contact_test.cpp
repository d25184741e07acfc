// Tests contact between free particles, which are spheres with the radius of their thickness.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "collision/narrow/point_contacts.h"
#include "pliant/world.h"

namespace pliant {
namespace {

Object particles(const std::vector<Vec3f>& positions, float thickness) {
  Object object;
  object.name = "grains";
  object.positions = positions;
  object.masses.assign(positions.size(), 1.f);
  object.thickness = thickness;
  object.self_collision = true;
  return object;
}

TEST(ParticleContact, KeepsMomentumAndTheShareOfSpeed) {
  for (const float restitution : {0.f, 0.5f, 1.f}) {
    Scene scene;
    scene.gravity = {};
    Object two = particles({{-0.2f, 0, 0}, {0.2f, 0, 0}}, 0.05f);
    two.velocities = {{2, 0, 0}, {-1, 0, 0}};
    two.masses = {1, 3};
    two.restitution = restitution;
    scene.add(two);
    World world(scene);
    for (int frame = 0; frame < 20; ++frame) world.step(1.f / 60);
    const std::vector<Vec3f> v = world.object(0).velocities(), x = world.object(0).positions();
    EXPECT_NEAR(v[0].x + 3 * v[1].x, -1, 1e-4) << restitution;
    EXPECT_NEAR(v[1].x - v[0].x, 3 * restitution, 0.02) << restitution;
    EXPECT_GE(x[1].x - x[0].x, 0.1f - 1e-4f);
  }
}

TEST(ParticleContact, LetsPassWhatPassesBy) {
  Scene scene;
  scene.gravity = {};
  Object two = particles({{-0.5f, 0.11f, 0}, {0, 0, 0}}, 0.05f);
  two.velocities = {{30, 0, 0}, {0, 0, 0}};
  scene.add(two);
  World world(scene);
  for (int frame = 0; frame < 3; ++frame) world.step(1.f / 60);
  EXPECT_EQ(world.object(0).velocities()[0], (Vec3f{30, 0, 0}));
  EXPECT_EQ(world.object(0).velocities()[1], Vec3f{});
}

TEST(ParticleContact, AColumnRestsOnTheGroundInOrder) {
  Scene scene;
  scene.settings.substeps = 20;
  scene.settings.iterations = 4;
  std::vector<Vec3f> column;
  for (int i = 0; i < 8; ++i) column.push_back({0, 0.06f + 0.12f * static_cast<float>(i), 0});
  Object grains = particles(column, 0.05f);
  scene.add(grains);
  scene.add(Collider{});
  World world(scene);
  for (int frame = 0; frame < 180; ++frame) world.step(1.f / 60);
  const std::vector<Vec3f> x = world.object(0).positions(), v = world.object(0).velocities();
  for (int i = 0; i < 8; ++i) {
    const float wanted = 0.05f + 0.1f * static_cast<float>(i);
    EXPECT_NEAR(x[static_cast<std::size_t>(i)].y, wanted, 0.01f) << i;
    EXPECT_LT(std::abs(v[static_cast<std::size_t>(i)].y), 0.05f) << i;
  }
}

TEST(ParticleContact, NothingPassesAHeadOnGrainAtModerateSpeed) {
  for (const float speed : {1.f, 10.f, 50.f}) {
    Scene scene;
    scene.gravity = {};
    Object two = particles({{-0.5f, 0.001f, 0}, {0, 0, 0}}, 0.01f);
    two.velocities = {{speed, 0, 0}, {0, 0, 0}};
    scene.add(two);
    World world(scene);
    for (int frame = 0; frame < 60; ++frame) world.step(1.f / 60);
    EXPECT_LT(world.object(0).positions()[0].x, world.object(0).positions()[1].x) << speed;
  }
}

TEST(ParticleContact, FindsWhatEveryPairByItselfFinds) {
  std::mt19937 random(5);
  const auto uniform = [&](float range) { return std::uniform_real_distribution<float>(-range, range)(random); };
  for (int round = 0; round < 20; ++round) {
    PairModel model;
    std::vector<Record> positions, displacements, remainders(300);
    for (int i = 0; i < 300; ++i) {
      const float x = uniform(1), y = uniform(1), z = uniform(1), far = i % 20 == 0 ? 1.f : 0.02f;
      positions.push_back({x, y, z, i % 7 == 0 ? 0.f : 1.f});
      const float a = uniform(far), b = uniform(far), c = uniform(far);
      displacements.push_back({a, b, c, 0});
      model.free_points.push_back(i);
      model.shared->vertex_body.push_back(i % 3);
    }
    for (int body = 0; body < 3; ++body) {
      ContactBody of;
      of.meets_itself = body != 1;
      of.thickness = 0.05f + 0.02f * static_cast<float>(body);
      model.shared->rules.add(of);
    }
    model.largest_thickness = model.shared->rules.largest_thickness({0, 1, 2});
    const PairParticles all{positions.data(), remainders.data(), displacements.data(), 0.01f};
    std::vector<Contact> found, wanted;
    Executor executor(1);
    PointContacts(model).detect(executor, all, found);
    for (int i = 0; i < 300; ++i)
      for (int j = i + 1; j < 300; ++j) {
        Contact contact;
        if (model.shared->rules.meet(i % 3, j % 3) &&
            find_point_contact(i, j, model.shared->rules.material(i % 3, j % 3), all, contact))
          wanted.push_back(contact);
      }
    ASSERT_GT(wanted.size(), 50u);
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].point, wanted[i].point);
      EXPECT_EQ(found[i].normal, wanted[i].normal);
      EXPECT_EQ(found[i].gap, wanted[i].gap);
    }
  }
}

}  // namespace
}  // namespace pliant
