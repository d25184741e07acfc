// Tests user-defined types in a World: with frames, several rows, eight points. Known answers, conservation, the same
// bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "constraints/isometric_bending.h"
#include "pliant/error.h"
#include "pliant/world.h"
#include "support/stencil_types.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float fixed = std::numeric_limits<float>::infinity();
constexpr float frame_time = 1 / 60.f;

class UserTypes : public testing::Test {
 protected:
  static void SetUpTestSuite() { register_test_types(); }

  static Settings settings(int substeps, int threads = 1) {
    Settings settings;
    settings.sweep = Sweep::tiled;
    settings.substeps = substeps;
    settings.threads = threads;
    return settings;
  }
};

ConstraintGroup group(const std::string& type, const std::vector<int>& stencils, const std::vector<float>& rest,
                      const Stiffness& stiffness = {}) {
  ConstraintGroup made;
  made.type = type;
  made.particles = stencils;
  made.rest = rest;
  made.stiffness = stiffness;
  return made;
}

/// A rod from the origin with its centre of mass at `centre`: a fixed particle and frame, and a body.
Object rod(const Vec3f& centre, float mass, const Vec3f& inertia) {
  Object object;
  object.name = "rod";
  object.positions = {{0, 0, 0}, centre};
  object.masses = {fixed, mass};
  object.frames = {{{}, {}, {fixed, fixed, fixed}}, {{}, {}, inertia}};
  object.constraints = {group("test_joint", {0, 0, 1, 1}, {0, 0, 0, -centre.x, -centre.y, -centre.z})};
  return object;
}

TEST_F(UserTypes, ARodSwingsWithThePeriodOfAPhysicalPendulum) {
  const float length = 1, mass = 2, amplitude = 0.1f, across = mass * length * length / 12;
  Scene scene;
  const float half = length / 2;
  scene.add(rod({half * std::sin(amplitude), -half * std::cos(amplitude), 0}, mass, {across, across, across}));
  World world(scene, settings(100));
  std::vector<double> crossings;
  double before = 1, anchor = 0;
  for (int frame = 0; frame < 600; ++frame) {
    ASSERT_TRUE(world.step(frame_time).ok());
    const double now = world.object(0).positions()[1].x;
    if (before > 0 && now <= 0) crossings.push_back((frame + before / (before - now)) * frame_time);
    before = now;
    anchor = std::max(anchor, world.measure().residuals()[0].largest);
  }
  ASSERT_GE(crossings.size(), 5u);
  const double period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  const double known = 2 * std::acos(-1.0) * std::sqrt((across + mass * half * half) / (mass * 9.81 * half));
  EXPECT_NEAR(period / known, 1 + amplitude * amplitude / 16, 0.002);
  EXPECT_LT(anchor, 1e-5) << "the gap of the joint";
}

/// Bodies in space, each joined to the next, that tumble.
Scene tumbling_chain(int bodies) {
  std::mt19937 random(5);
  const auto uniform = [&] { return static_cast<float>(static_cast<double>(random()) / 4294967295.0 * 2 - 1); };
  Scene scene;
  scene.gravity = {0, 0, 0};
  Object object;
  object.name = "chain";
  ConstraintGroup joints = group("test_joint", {}, {});
  for (int i = 0; i < bodies; ++i) {
    object.positions.push_back({static_cast<float>(i), 0, 0});
    object.velocities.push_back({uniform(), uniform(), uniform()});
    object.masses.push_back(1 + 0.5f * uniform());
    object.frames.push_back({{}, {uniform(), uniform(), uniform()}, {0.1f, 0.2f, 0.25f}});
    if (i == 0) continue;
    joints.particles.insert(joints.particles.end(), {i - 1, i - 1, i, i});
    joints.rest.insert(joints.rest.end(), {0.5f, 0, 0, -0.5f, 0, 0});
  }
  object.constraints = {joints};
  scene.add(object);
  return scene;
}

struct Momenta {
  Vec3d linear{}, angular{};
};

Momenta momenta_of(const World& world, const Scene& scene) {
  Momenta sum;
  const auto x = world.object(0).positions(), v = world.object(0).velocities(),
             w = world.object(0).angular_velocities();
  const auto q = world.object(0).orientations();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double m = static_cast<double>(scene.objects[0].masses[i]);
    const Vec3d place{x[i].x, x[i].y, x[i].z}, impulse{m * v[i].x, m * v[i].y, m * v[i].z};
    const Vec3f local = rotate(conjugate(q[i]), w[i]), inertia = scene.objects[0].frames[i].inertia;
    const Vec3f spin = rotate(q[i], Vec3f{local.x * inertia.x, local.y * inertia.y, local.z * inertia.z});
    sum.linear += impulse;
    sum.angular += cross(place, impulse) + Vec3d{spin.x, spin.y, spin.z};
  }
  return sum;
}

TEST_F(UserTypes, AChainOfBodiesInSpaceKeepsItsMomenta) {
  const Scene scene = tumbling_chain(5);
  World world(scene, settings(100));
  const Momenta before = momenta_of(world, scene);
  for (int frame = 0; frame < 120; ++frame) ASSERT_TRUE(world.step(frame_time).ok());
  const Momenta after = momenta_of(world, scene);
  const auto difference = [](const Vec3d& a, const Vec3d& b) { return std::sqrt(length_squared(a - b)); };
  EXPECT_LT(difference(before.linear, after.linear), 1e-4 * (1 + std::sqrt(length_squared(before.linear))));
  EXPECT_LT(difference(before.angular, after.angular), 5e-3 * std::sqrt(length_squared(before.angular)));
}

TEST_F(UserTypes, AFreeBodyTumblesAsEulersEquationsSay) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  Object object;
  object.name = "body";
  object.positions = {{0, 0, 0}};
  object.masses = {1};
  object.frames = {{{}, {0.01f, 1, 0}, {1, 2, 3}}};
  scene.add(object);
  World world(scene, settings(10));
  const double energy = world.measure().kinetic_energy();
  const Vec3d momentum = momenta_of(world, scene).angular;
  // Rotation about the middle axis is unstable: w_y goes from 1 to -1 within half a period of 20.7546 s.
  double half_period = 0;
  for (int frame = 0; frame < 1500; ++frame) {
    ASSERT_TRUE(world.step(frame_time).ok());
    const Vec3f local = rotate(conjugate(world.object(0).orientations()[0]), world.object(0).angular_velocities()[0]);
    if (half_period == 0 && local.y < 0) half_period = 2 * (frame + 0.5) * frame_time;
  }
  EXPECT_NEAR(half_period, 20.75461, 0.05);
  EXPECT_NEAR(world.measure().kinetic_energy() / energy, 1, 1e-4);
  EXPECT_LT(std::sqrt(length_squared(momenta_of(world, scene).angular - momentum)), 2e-3);
}

TEST_F(UserTypes, TwoBarsHangAWeightWhereTwoDistancesDo) {
  Object object;
  object.name = "truss";
  object.positions = {{-1, 0, 0}, {1, 0, 0}, {0.2f, -1, 0}};
  object.masses = {fixed, fixed, 3};
  object.constraints = {group("two_bars", {0, 1, 2}, {}, Stiffness::compliance(1e-4f))};
  Scene one;
  one.add(object);
  object.constraints = {group("distance", {0, 2, 1, 2}, {}, Stiffness::compliance(1e-4f))};
  Scene two;
  two.add(object);
  for (Scene* scene : {&one, &two}) scene->objects[0].damping = 20;
  World truss(one, settings(50)), bars(two, settings(50));
  for (int frame = 0; frame < 600; ++frame) {
    ASSERT_TRUE(truss.step(frame_time).ok());
    ASSERT_TRUE(bars.step(frame_time).ok());
  }
  const Vec3f a = truss.object(0).positions()[2], b = bars.object(0).positions()[2];
  EXPECT_NEAR(a.x, b.x, 2e-5f);
  EXPECT_NEAR(a.y, b.y, 2e-5f);
  EXPECT_LT(a.y, -1.001f) << "the weight stretches the bars";
  EXPECT_EQ(truss.object(0).info().constraints[0].first, "two_bars");
}

TEST_F(UserTypes, RigidBarsAreMetAtOnceAndTheirMultipliersAreTheForces) {
  Object object;
  object.name = "truss";
  object.positions = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}};
  object.masses = {fixed, fixed, 3};
  object.constraints = {group("two_bars", {0, 1, 2}, {})};
  Scene scene;
  scene.add(object);
  Settings chosen = settings(2);
  chosen.record_multipliers = true;
  World world(scene, chosen);
  for (int frame = 0; frame < 120; ++frame) ASSERT_TRUE(world.step(frame_time).ok());
  EXPECT_LT(world.measure().residuals()[0].largest, 1e-6);
  const std::vector<float> multipliers = world.object(0).multipliers("two_bars");
  ASSERT_EQ(multipliers.size(), 2u);
  const double h = frame_time / 2.0, tension = 3 * 9.81 / std::sqrt(2.0);  // half the weight on each, at 45 degrees
  for (float multiplier : multipliers) EXPECT_NEAR(-multiplier / (h * h) / tension, 1, 0.01);
}

TEST_F(UserTypes, EightPointsKeepTheirSpread) {
  Object object;
  object.name = "eight";
  for (int i = 0; i < 8; ++i) {
    object.positions.push_back({float(i & 1), float(i >> 1 & 1), float(i >> 2 & 1)});
    object.velocities.push_back({0.1f * static_cast<float>(i), 0, 0});
    object.masses.push_back(1);
  }
  object.constraints = {group("spread", {0, 1, 2, 3, 4, 5, 6, 7}, {})};
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.add(object);
  World world(scene, settings(20));
  for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(frame_time).ok());
  const auto x = world.object(0).positions();
  Vec3d mean{};
  for (const Vec3f& p : x) mean += Vec3d{p.x, p.y, p.z} * 0.125;
  double squares = 0;
  for (const Vec3f& p : x) squares += length_squared(Vec3d{p.x, p.y, p.z} - mean) / 8;
  EXPECT_NEAR(std::sqrt(squares), std::sqrt(0.75), 1e-5);
  EXPECT_NEAR(mean.x, 0.5 + 0.35, 1e-4) << "and drift as before";
}

/// A single hinge whose edge is fixed, bent at the start.
Scene hinge(const std::string& type, const Stiffness& stiffness) {
  Object object;
  object.name = "hinge";
  object.positions = {{0.3f, 5, 0.1f}, {1.3f, 5.2f, -0.2f}, {0.7f, 5.3f, 0.9f}, {0.8f, 5.6f, -0.7f}};
  object.masses = {fixed, fixed, 0.7f, 0.4f};
  object.constraints = {group(type, {0, 1, 2, 3}, {-3.1f, 1.5f, 1.7f}, stiffness)};
  Scene scene;
  scene.add(object);
  return scene;
}

TEST_F(UserTypes, OneAtATimeGivesTheBitsOfLanes) {
  ConstraintDefinition own = detail::definition_of<IsometricBending>();
  own.name = "own_bending";
  register_constraint(own);
  for (const Stiffness& stiffness :
       {Stiffness{}, Stiffness::compliance(1e-3f), Stiffness::compliance(1e-3f, 0.05f), Stiffness::pbd(0.4f)}) {
    Settings many = settings(7);
    many.iterations = 3;
    World one(hinge("own_bending", stiffness), many), library(hinge("isometric_bending", stiffness), many);
    for (int frame = 0; frame < 30; ++frame) {
      ASSERT_TRUE(one.step(frame_time).ok());
      ASSERT_TRUE(library.step(frame_time).ok());
    }
    EXPECT_EQ(one.object(0).positions(),
              library.object(0).positions());  // compared in the user's order, because a State has its own
    EXPECT_EQ(one.object(0).velocities(), library.object(0).velocities());
    EXPECT_LT(one.object(0).positions()[2].y, 5.2f) << "it has moved";
  }
}

TEST_F(UserTypes, SameBitsOnAnyThreadsInEverySweepAndAfterRestore) {
  const Scene scene = tumbling_chain(700);  // colours with enough batches for several threads
  for (const NamedSweep& way : sweeps()) {
    std::string hash;
    for (int threads : {1, 2, 4}) {
      Settings chosen = settings(4, threads);
      chosen.sweep = way.sweep;
      World world(scene, chosen);
      ASSERT_TRUE(world.step(frame_time).ok()) << way.name;
      const State kept = world.state();
      ASSERT_TRUE(world.step(frame_time).ok()) << way.name;
      if (hash.empty()) hash = world.state_hash();
      EXPECT_EQ(world.state_hash(), hash) << way.name << ", threads " << threads;
      world.restore(kept);
      ASSERT_TRUE(world.step(frame_time).ok());
      EXPECT_EQ(world.state_hash(), hash) << way.name << ", after restore";
    }
  }
}

TEST_F(UserTypes, AStateOfOtherFramesIsRefused) {
  const Scene scene = tumbling_chain(3);
  World world(scene, settings(4));
  State fewer = world.state();
  fewer.frames.orientations.pop_back();
  EXPECT_THROW(world.restore(fewer), Error);
  State other = world.state();
  other.frames.inverse_inertias[1].y *= 2;
  EXPECT_THROW(world.restore(other), Error);
  State turned = world.state();
  turned.frames.orientations[0] = {1, 0, 0, 0};
  EXPECT_NE(hash(turned), hash(world.state()));
}

TEST_F(UserTypes, AFrameThatDoesNotExistAndRestDataThatCantBeMeasuredAreRefused) {
  Scene scene;
  scene.add(rod({0, -1, 0}, 1, {1, 1, 1}));
  scene.objects[0].constraints[0].particles[3] = 2;
  EXPECT_THROW(World(scene, settings(4)), Error);
  scene.objects[0].constraints[0].particles[3] = 1;
  scene.objects[0].constraints[0].rest.clear();
  EXPECT_THROW(World(scene, settings(4)), Error);
}

TEST_F(UserTypes, ATypeIsKnownOnceAndAnotherOfItsNameIsRefused) {
  const std::size_t before = constraint_types().size();
  register_constraint<TestJoint>();
  EXPECT_EQ(constraint_types().size(), before);
  ConstraintDefinition other = detail::definition_of<TwoBars>();
  other.name = "distance";
  EXPECT_THROW(register_constraint(other), Error);
  const auto& types = constraint_types();
  const ConstraintType& found =
      *std::find_if(types.begin(), types.end(), [](const ConstraintType& type) { return type.name == "test_joint"; });
  EXPECT_EQ(found.rows, 3);
  EXPECT_EQ(found.slots, (std::vector<SlotKind>{SlotKind::point, SlotKind::frame, SlotKind::point, SlotKind::frame}));
}

}  // namespace
}  // namespace pliant
