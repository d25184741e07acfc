// Tests which sweep and substeps an object gets that is added to a World: those of a scene that has all of it from the
// start.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A sheet whose springs lie in no rows, so that multigrid suits it where it meets nothing.
Object irregular(const std::string& name, const Vec3f& at) {
  TriangleMesh mesh = grid_mesh(12, 12, 1, 1);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> by(-0.03f, 0.03f);
  for (Vec3f& p : mesh.positions) {
    const float x = by(random), z = by(random);
    p += at + Vec3f{x, 0, z};
  }
  ClothOptions options;
  options.name = name;
  return make_cloth(mesh, options);
}

Object hung_at(const Vec3f& at) {
  Object cloth = sheet_at("hung", at, 24, 1);
  cloth.pins = {{0, {}}, {23, {}}};
  return cloth;
}

/// A short rubber rope with a weight, which stretches by half of its length.
Object bungee() {
  Object rope = chain(10, 0.1f, Stiffness::compliance(2e-2f));
  rope.name = "bungee";
  for (Vec3f& p : rope.positions) p.x += 9;
  rope.masses.assign(10, 0.01f);
  rope.masses.back() = 0.2f;
  rope.pins = {{0, {}}};
  return rope;
}

MeshCollider ground(MeshCollider::As as) {
  MeshCollider collider;
  collider.name = "ground";
  collider.mesh = as == MeshCollider::As::heightfield ? grid_mesh(4, 4, 30, 30) : sphere_mesh(2);
  for (Vec3f& p : collider.mesh.positions) p.y -= 6;
  collider.as = as;
  return collider;
}

/// Adds an object to a World of the scene, and expects what a World gives that has it from the start.
void expect_same_choice(const Scene& scene, const Object& added, const std::string& what) {
  SCOPED_TRACE(what);
  Scene all = scene;
  all.add(added);
  World world(scene);
  const ObjectId id = world.add(added);
  const World from_the_start(all);
  const Sweep expected = chosen_sweep(all, static_cast<int>(scene.objects.size()));
  EXPECT_EQ(sweep_name(world.layout().sweeps.back()), sweep_name(expected));
  EXPECT_EQ(world.object(id).info().substeps, from_the_start.object(from_the_start.objects().back()).info().substeps);
}

TEST(AddedObject, GetsTheSweepThatItHasInAScene) {
  Scene empty, one, two;
  one.add(hung_at({5, 0, 0}));
  two = one;
  two.add(irregular("other", {-5, 0, 0}));
  for (const Scene& scene : {empty, one, two}) {
    SCOPED_TRACE(scene.objects.size());
    expect_same_choice(scene, irregular("new", {}), "meets nothing");
    expect_same_choice(scene, hung_at({}), "hangs");
    expect_same_choice(scene, bungee(), "is coarse and meant to stretch");
    Object sock = hung_at({});
    sock.self_collision = true;
    expect_same_choice(scene, sock, "touches itself");
    Scene with = scene;
    with.add(Collider{});
    expect_same_choice(with, irregular("new", {0, 3, 0}), "meets a plane");
    for (const auto as :
         {MeshCollider::As::triangles, MeshCollider::As::distance_grid, MeshCollider::As::heightfield}) {
      with = scene;
      with.add(ground(as));
      expect_same_choice(with, irregular("new", {}), "meets a mesh");
    }
  }
}

TEST(AddedObject, GetsTheSweepThatTheSettingsName) {
  Scene scene;
  scene.add(hung_at({5, 0, 0}));
  scene.settings.sweep = Sweep::symmetric;
  scene.settings.substeps = 7;
  World world(scene);
  const ObjectId id = world.add(hung_at({}));
  EXPECT_EQ(world.layout().sweeps.back(), Sweep::symmetric);
  EXPECT_EQ(world.object(id).info().substeps, 7);
}

TEST(AddedObject, GetsTheSameInAWorldMadeFromALayout) {
  Scene scene;
  scene.add(hung_at({5, 0, 0}));
  World world(scene);
  world.step(dt);
  scene.settings = world.settings();
  World again(scene, world.layout());
  again.restore(world.state());
  for (World* one : {&world, &again}) {
    one->add(irregular("new", {}));
    for (int frame = 0; frame < 3; ++frame) one->step(dt);
  }
  EXPECT_EQ(world.layout().sweeps, again.layout().sweeps);
  EXPECT_EQ(world.layout().sweeps, (std::vector<Sweep>{Sweep::tethered_chains, Sweep::multigrid}));
  EXPECT_EQ(world.state_hash(), again.state_hash());
}

/// Tethers hold an object at the length that it has at rest.
TEST(CoarseObject, IsNotTetheredBesideClothThatHangs) {
  const auto longest = [](const Scene& scene) {
    World world(scene);
    double most = 0;
    for (int frame = 0; frame < 60; ++frame) {
      world.step(dt);
      const std::vector<Vec3f> x = world.object(0).positions();
      most = std::max(most, std::sqrt(double(length_squared(x.back() - x.front()))));
    }
    return most;
  };
  Scene scene;
  scene.add(bungee());
  const double alone = longest(scene);
  scene.add(hung_at({}));
  EXPECT_GT(alone, 1.3);
  EXPECT_NEAR(longest(scene), alone, 0.01 * alone);
  EXPECT_EQ(chosen_sweep(scene, 0), Sweep::chains);
  EXPECT_EQ(chosen_sweep(scene, 1), Sweep::tethered_chains);
  EXPECT_EQ(World(scene).layout().sweeps, (std::vector<Sweep>{Sweep::chains, Sweep::tethered_chains}));
  scene.objects[0].constraints[0].stiffness = Stiffness::rigid();
  EXPECT_EQ(chosen_sweep(scene, 0), Sweep::tethered_chains) << "which it needs no less than the cloth";
}

}  // namespace
}  // namespace pliant
