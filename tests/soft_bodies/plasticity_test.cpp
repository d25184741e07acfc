// Plastic tetrahedra and hinges against known answers: what is left of a strain that was held.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "pliant/edit.h"
#include "pliant/error.h"
#include "soft_bodies/soft_body_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float ratio_of_clay = 0.4f;

/// A bar of 1 m along x, without weight.
Scene bar_of(const Plasticity& plasticity, int substeps) {
  SoftBodyOptions options;
  options.material = solid_of(1e5f, ratio_of_clay);
  options.material.plasticity = plasticity;
  Object object = make_soft_body(box_tetrahedra({1, 0.2f, 0.2f}, {8, 2, 2}), options);
  object.collides = false;
  object.damping = 10;
  Scene scene = scene_of(std::move(object), substeps);
  scene.gravity = {};
  return scene;
}

/// Holds every particle of a bar where it is `stretch` times as long at the same volume, lets it go after `seconds`,
/// and returns the logarithmic strain that is left. As it springs back nothing flows.
double strain_left(const Scene& scene, double stretch, double seconds) {
  World world(scene);
  const Object& object = scene.objects[0];
  Edit held = unchanged(object);
  for (float& mass : held.object.masses) mass = INFINITY;
  world.edit(0, held);
  std::vector<int> all;
  std::vector<Vec3f> targets;
  const auto along = static_cast<float>(stretch), across = static_cast<float>(1 / std::sqrt(stretch));
  for (const Vec3f& p : object.positions) {
    all.push_back(static_cast<int>(all.size()));
    targets.push_back({p.x * along, p.y * across, p.z * across});
  }
  world.object(0).set_targets(all, targets);
  run(world, static_cast<int>(std::lround(seconds * 60)));
  Edit free = unchanged(object);
  for (ConstraintGroup& group : free.object.constraints)
    if (group.plasticity) group.plasticity->yield = 1e30f;
  world.edit(0, free);
  run(world, 240);
  const std::vector<Vec3f> now = positions_of(world);
  Vec3d between{};  // the middles of the ends, which have nine particles each
  for (std::size_t i = 0; i < now.size(); ++i)
    if (std::abs(object.positions[i].x) > 0.499f)
      between += convert<double>(now[i]) * (object.positions[i].x > 0 ? 1 / 9.0 : -1 / 9.0);
  return std::log(length(between));
}

TEST(Plasticity, WhatIsBelowTheYieldStrainSpringsBack) {
  EXPECT_NEAR(strain_left(bar_of({.yield = 0.2f}, 20), 1.2, 0.5), 0, 1e-4);
}

TEST(Plasticity, ABarKeepsWhatIsBeyondTheYieldStrain) {
  for (const double stretch : {0.5, 1.3, 2.0}) {
    const double beyond = std::fabs(std::log(stretch)) - 0.1;
    EXPECT_NEAR(strain_left(bar_of({.yield = 0.1f}, 20), stretch, 0.1) / std::copysign(beyond, std::log(stretch)), 1,
                2e-3)
        << stretch;
  }
}

TEST(Plasticity, SubstepsDoNotChangeWhatABarKeeps) {
  const double few = strain_left(bar_of({.yield = 0.1f}, 4), 1.4, 0.1);
  EXPECT_NEAR(few / strain_left(bar_of({.yield = 0.1f}, 40), 1.4, 0.1), 1, 1e-3);
}

// A Maxwell solid that is held: its elastic strain decays at the rate.
TEST(Plasticity, ABarCreepsAtItsRate) {
  const double rate = 0.8, ramp = 1.0 / 60;  // half of it counts
  for (const double seconds : {0.5, 1.5}) {
    const double left = strain_left(bar_of({.yield = 0, .rate = static_cast<float>(rate)}, 20), 1.5, seconds);
    EXPECT_NEAR(left / (std::log(1.5) * (1 - std::exp(-rate * (seconds - ramp / 2)))), 1, 5e-3) << seconds;
  }
}

TEST(Plasticity, NothingFlowsBeyondTheMost) {
  const double left = strain_left(bar_of({.yield = 0.05f, .most = 0.1f}, 20), 1.5, 0.5);
  EXPECT_LT(left, 0.1 + 1e-4);
  EXPECT_GT(left, 0.099);
}

TEST(Plasticity, TheVolumeDoesNotFlow) {
  const Scene scene = bar_of({.yield = 0.05f}, 20);
  const Object& object = scene.objects[0];
  const std::vector<std::array<int, 4>> tetrahedra = tetrahedra_of(object);
  World world(scene);
  std::vector<int> right;
  std::vector<Vec3f> targets;
  Edit held = unchanged(object);
  for (int i = 0; i < static_cast<int>(object.positions.size()); ++i) {
    const Vec3f at = object.positions[static_cast<std::size_t>(i)];
    if (std::abs(at.x) < 0.499f) continue;
    held.object.masses[static_cast<std::size_t>(i)] = INFINITY;
    if (at.x < 0) continue;
    right.push_back(i);
    targets.push_back({-at.y + 0.3f, at.x, at.z});  // turned by a quarter, and moved
  }
  world.edit(0, held);
  world.object(0).set_targets(right, targets);
  run(world, 60);
  world.edit(0, unchanged(object));
  run(world, 240);
  const auto sum = [](const std::vector<double>& all) {
    double total = 0;
    for (const double one : all) total += one;
    return total;
  };
  const std::vector<Vec3f> now = positions_of(world), &rest = object.positions;
  EXPECT_NEAR(sum(six_volumes(now, tetrahedra)) / sum(six_volumes(rest, tetrahedra)), 1, 2e-3);
  double moved = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
    moved = std::max(moved, std::abs(static_cast<double>(now[i].y - rest[i].y)));
  EXPECT_GT(moved, 0.1);  // it stays bent
}

// ------------------------------------------------------------------------------------------------ State

/// A plastic ball that has fallen on a floor.
Scene dented() {
  SoftBodyOptions options;
  options.material = solid_of(5e3f, ratio_of_clay);
  options.material.plasticity = Plasticity{.yield = 0.02f, .rate = 5};
  Object object = make_soft_body(box_tetrahedra({0.3f, 0.3f, 0.3f}, {3, 3, 3}), options);
  for (Vec3f& p : object.positions) p.y += 0.5f;
  Scene scene = scene_of(std::move(object), 20);
  scene.colliders.push_back({.name = "floor"});
  return scene;
}

TEST(Plasticity, ARestoredStateGivesTheSameBits) {
  World world(dented());
  run(world, 30);
  const State half = world.state();
  EXPECT_EQ(half.flowed.size(), 9u * 162u);
  run(world, 30);
  const std::string end = hash(world.state());
  World other(dented());
  other.restore(half);
  EXPECT_EQ(hash(other.state()), hash(half));
  run(other, 30);
  EXPECT_EQ(hash(other.state()), end);
  world.restore(half);
  run(world, 30);
  EXPECT_EQ(hash(world.state()), end);
}

TEST(Plasticity, IsTheSameOnAnyNumberOfThreads) {
  std::string one;
  for (const int threads : {1, 2, 5}) {
    Scene scene = dented();
    scene.settings.threads = threads;
    World world(scene);
    run(world, 40);
    if (one.empty()) one = hash(world.state());
    EXPECT_EQ(hash(world.state()), one) << threads;
  }
}

TEST(Plasticity, AnEditKeepsWhatHasFlowed) {
  World world(dented());
  run(world, 40);
  const std::vector<float> before = world.state().flowed;
  Edit edit = unchanged(dented().objects[0]);
  edit.object.damping = 1;
  world.edit(0, edit);
  EXPECT_EQ(world.state().flowed, before);
}

TEST(Plasticity, AnEditOfTheRestShapeReplacesWhatHasFlowed) {
  World world(dented());
  run(world, 40);
  Edit edit = unchanged(dented().objects[0]);
  for (Vec3f& p : edit.object.positions) p.x *= 1.25f;
  world.edit(0, edit);
  Scene scene = dented();
  scene.objects[0] = edit.object;
  EXPECT_EQ(world.state().flowed, World(scene).state().flowed);
}

TEST(Plasticity, AStateWithAnotherNumberOfFlowedDataIsRefused) {
  World world(dented());
  run(world, 2);
  State state = world.state();
  state.flowed.pop_back();
  EXPECT_THROW(world.restore(state), Error);
  state = world.state();
  state.flowed[3] = NAN;
  EXPECT_THROW(world.restore(state), Error);
}

// ------------------------------------------------------------------------------------------------ hinges

TEST(Plasticity, AFoldBeyondTheYieldAngleStays) {
  const TriangleMesh square{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  ClothOptions options;
  options.bending = Stiffness::compliance(1e-3f);
  options.bending_plasticity = Plasticity{.yield = 0.4f};
  Object sheet = make_cloth(square, options);
  sheet.collides = false;
  Scene scene = scene_of(sheet, 20);
  scene.gravity = {};
  scene.objects[0].damping = 2;
  World world(scene);
  Edit held = unchanged(scene.objects[0]);
  for (float& mass : held.object.masses) mass = INFINITY;
  world.edit(0, held);
  const float angle = 1.5f;
  const std::vector<int> tips{2};
  for (int frame = 1; frame <= 60; ++frame) {
    const float now = angle * static_cast<float>(frame) / 60;
    const std::vector<Vec3f> place{{std::cos(now), std::sin(now), 0}};
    world.object(0).set_targets(tips, place);
    run(world, 1);
  }
  world.edit(0, unchanged(scene.objects[0]));
  run(world, 300);
  const std::vector<Vec3f> x = positions_of(world);
  const Vec3f axis = x[1] - x[0], a = cross(axis, x[2] - x[0]), b = cross(x[3] - x[0], axis);
  const double cosine =
      static_cast<double>(dot(a, b)) / std::sqrt(static_cast<double>(dot(a, a)) * static_cast<double>(dot(b, b)));
  EXPECT_NEAR(std::acos(std::min(1.0, cosine)), 1.5 - 0.4, 0.02);
}

// Without a limit rest shapes become so flat that a world ends in numbers that are not finite.
TEST(Plasticity, MatterWithoutAYieldStrainEndsAsAPuddle) {
  for (const float yield : {0.f, 0.005f, 0.02f}) {
    SoftBodyOptions options;
    options.material = elastic_solid("gelatine");
    options.material.plasticity = Plasticity{.yield = yield};
    Object object = make_soft_body(box_tetrahedra({0.1f, 0.1f, 0.1f}, {4, 4, 4}), options);
    for (Vec3f& p : object.positions) p.y += 0.6f;
    Scene scene = scene_of(std::move(object), 0);
    scene.colliders.push_back({.name = "floor"});
    World world(scene);
    run(world, 150);
  }
}

/// A shape without volume has no strain; what tetrahedra are pressed to must not make their rest shapes infinite.
TEST(Plasticity, StaysFiniteWherePressedFlat) {
  const Scene scene = bar_of({.yield = 0.01f}, 4);
  const Object& object = scene.objects[0];
  World world(scene);
  Edit held = unchanged(object);
  for (float& mass : held.object.masses) mass = INFINITY;
  world.edit(0, held);
  std::vector<int> all(object.positions.size());
  std::iota(all.begin(), all.end(), 0);
  for (const float height : {0.01f, 1e-5f, 1e-7f, 1e-8f, 0.f}) {
    std::vector<Vec3f> flat;
    for (const Vec3f& p : object.positions)
      flat.push_back({0.8f * p.x - 0.6f * p.y * height, 0.6f * p.x + 0.8f * p.y * height, p.z});
    world.object(0).set_targets(all, flat);
    run(world, 3);
    for (const float number : world.state().flowed) EXPECT_LT(std::abs(number), 400) << height;  // per metre
  }
  world.edit(0, unchanged(object));
  run(world, 60);
}

TEST(Plasticity, IsRefusedWhereItMeansNothing) {
  Object rope = make_rope({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  rope.constraints[0].plasticity = Plasticity{};
  EXPECT_THROW(World(scene_of(rope, 1)), Error);
  SoftBodyOptions options;
  options.material.plasticity = Plasticity{.yield = -1};
  EXPECT_THROW((void)make_soft_body(box_tetrahedra({1, 1, 1}, {1, 1, 1}), options), Error);
}

}  // namespace
}  // namespace pliant
