// A body that many ties hold moves as one rigid whole with what is tied to it, however light it is and however small
// the substeps are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "constraints/registry.h"
#include "model/tied_bodies.h"
#include "pliant/body.h"
#include "pliant/world.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;

/// A slender body of 50 g along x, with 72 particles of 10 g about it that are tied to it. All turn about z by `spin`
/// [rad/s].
Object pincushion(float spin) {
  BodyOptions options;
  options.name = "needle";
  options.mass = 0.05f;
  options.angular_velocity = {0, 0, spin};
  Object object = make_body({{Capsule{0.015f, 0.075f}, {}, {0, 0, std::sqrt(0.5f), std::sqrt(0.5f)}}}, options);
  object.collides = false;
  std::vector<int> all;
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 3; ++z) {
        const Vec3f at{0.02f * (static_cast<float>(x) - 3.5f), 0.03f * static_cast<float>(y - 1),
                       0.03f * static_cast<float>(z - 1)};
        all.push_back(static_cast<int>(object.positions.size()));
        object.positions.push_back(at);
        object.velocities.resize(object.positions.size());
        object.velocities.back() = {-spin * at.y, spin * at.x, 0};
        object.masses.push_back(0.01f);
      }
  attach(object, all, 0);
  return object;
}

World world_of(Object object, int substeps, Vec3f gravity) {
  Scene scene;
  scene.gravity = gravity;
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  scene.add(std::move(object));
  return World(scene);
}

double size_of(const Vec3f& v) { return std::sqrt(static_cast<double>(dot(v, v))); }

double spin_of(const World& world) {
  const Record& w = world.state().frames.angular_velocities[0];
  return size_of({w.x, w.y, w.z});
}

double fastest_of(const World& world) {
  double fastest = 0;
  for (const Vec3f& v : world.object(0).velocities()) fastest = std::max(fastest, size_of(v));
  return fastest;
}

double widest_gap(World& world, int frames) {
  double widest = 0;
  for (int frame = 0; frame < frames; ++frame) widest = std::max(widest, world.step(dt).widest_tie.gap);
  return widest;
}

/// It turns about a principal axis, so its speed is constant. Its other principal moments differ, and z's is the
/// largest.
TEST(TiedBody, SpinsAsOneWholeAtAnySubsteps) {
  for (const int substeps : {20, 40, 200}) {
    constexpr float spin = 3;
    World world = world_of(pincushion(spin), substeps, {});
    EXPECT_LT(widest_gap(world, 120), 2e-5) << substeps;
    EXPECT_NEAR(spin_of(world), spin, 0.02 * spin) << substeps;
    EXPECT_LT(fastest_of(world), 1.02 * spin * std::sqrt(0.07 * 0.07 + 0.03 * 0.03)) << substeps;
  }
}

/// The energy of particles and of the body's turning [J].
double energy_of(const World& world) {
  const Measurements m = world.measure();
  const Record &w = world.state().frames.angular_velocities[0], &inverse = world.state().frames.inverse_inertias[0];
  const auto of = [](float speed, float over) {
    return 0.5 * static_cast<double>(speed) * speed / static_cast<double>(over);
  };
  return m.kinetic_energy() + m.potential_energy() + of(w.x, inverse.x) + of(w.y, inverse.y) + of(w.z, inverse.z);
}

/// Hung at a particle of one end, it is a pendulum that swings and turns in all directions.
TEST(TiedBody, SwingsWithoutGainOfEnergy) {
  for (const int substeps : {20, 100}) {
    Object object = pincushion(0);
    object.pins.push_back({1, {}});
    World world = world_of(std::move(object), substeps, {0, -9.81f, 0});
    const double start = energy_of(world), range = 0.77 * 9.81 * 0.08;  // its weight, by what its centre can rise
    double fastest = 0;
    for (int frame = 0; frame < 180; ++frame) {
      world.step(dt);
      fastest = std::max(fastest, fastest_of(world));
      EXPECT_LT(energy_of(world), start + 0.01 * range) << substeps << " " << frame;
    }
    EXPECT_GT(fastest, 1) << substeps;
  }
}

/// Four springs of 1 / compliance bear its weight.
TEST(TiedBody, SagsByTheComplianceOfItsTies) {
  BodyOptions options;
  options.mass = 2;
  Object object = make_body({{Box{{0.1f, 0.1f, 0.1f}}}}, options);
  std::vector<int> corners;
  for (const float x : {-0.1f, 0.1f})
    for (const float z : {-0.1f, 0.1f}) {
      corners.push_back(static_cast<int>(object.positions.size()));
      object.positions.push_back({x, 0, z});
      object.masses.push_back(INFINITY);
    }
  object.collides = false;
  object.damping = 5;
  attach(object, corners, 0, Stiffness::compliance(1e-3f));
  World world = world_of(std::move(object), 20, {0, -9.81f, 0});
  for (int frame = 0; frame < 300; ++frame) world.step(dt);
  EXPECT_NEAR(world.object(0).positions()[0].y, -2 * 9.81f * 1e-3f / 4, 2e-5f);
}

/// Rigid ties to fixed particles overdetermine a body; it stays.
TEST(TiedBody, StaysBetweenFixedParticles) {
  Object object = make_body({{Box{{0.1f, 0.1f, 0.1f}}}});
  std::vector<int> corners;
  for (const float x : {-0.1f, 0.1f})
    for (const float y : {-0.1f, 0.1f})
      for (const float z : {-0.1f, 0.1f}) {
        corners.push_back(static_cast<int>(object.positions.size()));
        object.positions.push_back({x, y, z});
        object.masses.push_back(INFINITY);
      }
  object.collides = false;
  attach(object, corners, 0);
  World world = world_of(std::move(object), 10, {0, -9.81f, 0});
  EXPECT_LT(widest_gap(world, 60), 1e-6);
}

/// A box of 1 kg and 0.2 m on a side that hangs from fixed particles at the middle of its upper face, turned by an
/// angle about x. `length` is that of the line along x on which they lie [m].
Object hung_at(int ties, float length, float angle) {
  BodyOptions options;
  options.mass = 1;
  options.rotation = {std::sin(angle / 2), 0, 0, std::cos(angle / 2)};
  options.position = {0, -0.1f * std::cos(angle), -0.1f * std::sin(angle)};
  Object object = make_body({{Box{{0.1f, 0.1f, 0.1f}}}}, options);
  object.collides = false;
  std::vector<int> all;
  for (int i = 0; i < ties; ++i) {
    all.push_back(static_cast<int>(object.positions.size()));
    object.positions.push_back({length * (static_cast<float>(i) / static_cast<float>(ties - 1) - 0.5f), 0, 0});
    object.masses.push_back(INFINITY);
  }
  attach(object, all, 0);
  return object;
}

/// Ties on a line are a hinge, at one place a ball joint: what they leave free swings with the period of a compound
/// pendulum, however many they are.
TEST(TiedBody, SwingsAboutFixedParticlesAsAPendulum) {
  constexpr double arm = 0.1, squared_radius = 0.2 * 0.2 / 6;  // of gyration about x
  const double period = 2 * 3.14159265 * std::sqrt((squared_radius + arm * arm) / (9.81 * arm));
  constexpr float angle = 0.1f;
  for (const float length : {0.2f, 0.f})
    for (const int ties : {3, 30, 300}) {
      World world = world_of(hung_at(ties, length, angle), 80, {0, -9.81f, 0});
      for (int frame = 0; frame < 24; ++frame) world.step(static_cast<float>(period / 48));
      EXPECT_NEAR(world.object(0).positions()[0].z, 0.1f * std::sin(angle), 1e-4f) << ties << " on " << length << " m";
      for (int frame = 0; frame < 24; ++frame) world.step(static_cast<float>(period / 48));
      EXPECT_NEAR(world.object(0).positions()[0].z, -0.1f * std::sin(angle), 1e-4f) << ties << " on " << length << " m";
    }
}

/// The numbers of body, frame and particle of each tie.
ConstraintList list_with_frames(const std::vector<std::array<int, 3>>& ties) {
  ConstraintList list;
  list.type = find_constraint_type("body_anchor");
  list.size = 3;
  for (const std::array<int, 3>& tie : ties) {
    for (const int number : tie) list.stencils.push_back(number);
    list.response.push_back(0);
  }
  return list;
}

ConstraintList list_of(const std::vector<std::array<int, 2>>& body_and_particle) {
  std::vector<std::array<int, 3>> ties;
  for (const auto& [body, particle] : body_and_particle) ties.push_back({body, 100 + body, particle});
  return list_with_frames(ties);
}

TEST(TiedBodies, AreThoseWithThreeTies) {
  const TiedBodies found = find_tied_bodies(list_of({{0, 5}, {0, 6}, {1, 7}, {0, 8}, {1, 9}}), 20);
  ASSERT_EQ(found.colours.size(), 1u);
  ASSERT_EQ(found.colours[0].size(), 1u);
  EXPECT_EQ(found.colours[0][0], (TiesOfBody{0, 1, 3}));
  EXPECT_EQ(found.singles, (std::vector<int>{2, 4}));
}

TEST(TiedBodies, ShareNoParticleInOneColour) {
  const TiedBodies found =
      find_tied_bodies(list_of({{0, 5}, {0, 6}, {0, 7}, {1, 7}, {1, 8}, {1, 9}, {2, 10}, {2, 11}, {2, 12}}), 20);
  ASSERT_EQ(found.colours.size(), 2u);
  EXPECT_EQ(found.colours[0], (std::vector<TiesOfBody>{{0, 1, 2}, {6, 7, 8}}));
  EXPECT_EQ(found.colours[1], (std::vector<TiesOfBody>{{3, 4, 5}}));
}

/// A body may be tied to another one's centre.
TEST(TiedBodies, ShareNoCentreInOneColour) {
  const TiedBodies found = find_tied_bodies(list_of({{0, 5}, {0, 6}, {0, 1}, {1, 7}, {1, 8}, {1, 9}}), 20);
  ASSERT_EQ(found.colours.size(), 2u);
  EXPECT_EQ(found.colours[0], (std::vector<TiesOfBody>{{0, 1, 2}}));
  EXPECT_EQ(found.colours[1], (std::vector<TiesOfBody>{{3, 4, 5}}));
}

TEST(TiedBodies, HaveOneFrame) {
  const TiedBodies found = find_tied_bodies(
      list_with_frames({{0, 100, 5}, {0, 101, 6}, {0, 100, 7}, {0, 101, 8}, {0, 100, 9}, {0, 101, 10}}), 20);
  ASSERT_EQ(found.colours.size(), 2u);
  EXPECT_EQ(found.colours[0], (std::vector<TiesOfBody>{{0, 2, 4}}));
  EXPECT_EQ(found.colours[1], (std::vector<TiesOfBody>{{1, 3, 5}}));
}

TEST(TiedBodies, LeaveOutASecondTieOfAParticle) {
  const TiedBodies found = find_tied_bodies(list_of({{0, 5}, {0, 5}, {0, 6}, {0, 7}}), 20);
  ASSERT_EQ(found.colours.size(), 1u);
  EXPECT_EQ(found.colours[0][0], (TiesOfBody{0, 2, 3}));
  EXPECT_EQ(found.singles, (std::vector<int>{1}));
}

}  // namespace
}  // namespace pliant
