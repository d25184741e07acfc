// Viscosity in Pa s: flows with known answers, momentum, and the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "fluids/fluid_support.h"
#include "pliant/body.h"
#include "pliant/liquid.h"
#include "pliant/world.h"
#include "support/refusal.h"
#include "support/run.h"
#include "support/same_bits.h"

namespace pliant {
namespace {

using std::numbers::pi;
using testing_support::frame_time;
using testing_support::in_double;
using testing_support::weightless;

constexpr double g = 9.81;
constexpr float spacing = 0.01f;

enum class WallKind { holds, slips };

Collider wall(const Vec3f& at, const Vec3f& axis, float degrees, WallKind kind) {
  Collider plane;
  plane.position = at;
  plane.rotation = rotation(axis, degrees);
  plane.static_friction = plane.kinetic_friction = kind == WallKind::slips ? 0 : 0.4f;
  return plane;
}

Object block(const Vec3f& low, const Vec3f& high, float viscosity, const std::string& name = "liquid") {
  return make_liquid(fill_box(low, high, spacing),
                     {.name = name, .fluid = {.spacing = spacing, .viscosity = viscosity}});
}

/// Liquid that falls between two plates, with planes of symmetry in front and behind.
Scene channel(float width, float viscosity, int substeps, WallKind plates = WallKind::holds) {
  const float depth = 16 * spacing;
  Scene scene = weightless(block({}, {width, 3 * width, depth}, viscosity), substeps);
  scene.gravity = {0, static_cast<float>(-g), 0};
  scene.add(wall({}, {0, 0, 1}, -90, plates));
  scene.add(wall({width, 0, 0}, {0, 0, 1}, 90, plates));
  scene.add(wall({}, {1, 0, 0}, 90, WallKind::slips));
  scene.add(wall({0, 0, depth}, {1, 0, 0}, -90, WallKind::slips));
  return scene;
}

/// The mean velocity downwards in the middle third of the height, by the way that particles go in a frame.
double fall(World& world) {
  for (int i = 0; i < 12; ++i) world.step(frame_time);
  const std::vector<Vec3f> before = world.object(0).positions();
  world.step(frame_time);
  const std::vector<Vec3f> after = world.object(0).positions();
  float low = before[0].y, high = low;
  for (const Vec3f& p : before) low = std::min(low, p.y), high = std::max(high, p.y);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (std::abs(before[i].y - (low + high) / 2) > (high - low) / 6) continue;
    sum += static_cast<double>((before[i].y - after[i].y) / frame_time);
    ++count;
  }
  return sum / count;
}

double poiseuille(float width, float viscosity) {
  return 1000 * g * static_cast<double>(width * width) / (12 * static_cast<double>(viscosity));
}

// rho g d^2 / (12 mu), whatever the viscosity and the substeps. Planes of symmetry take pairs from the particles next
// to them, and particles out of their lattice have fewer near neighbours: the flow is 7 to 14 % too fast.
TEST(Viscosity, LetsLiquidFallBetweenPlatesAsPoiseuilleSays) {
  constexpr float width = 12 * spacing;
  for (const auto& [viscosity, substeps] : {std::pair{100.f, 10}, {100.f, 40}, {1000.f, 10}, {10000.f, 10}}) {
    World world(channel(width, viscosity, substeps));
    const double expected = poiseuille(width, viscosity);
    EXPECT_NEAR(fall(world), expected, 0.15 * expected) << viscosity << " Pa s, " << substeps << " substeps";
  }
}

TEST(Viscosity, LetsLiquidSlipAlongWallsWithoutFriction) {
  World world(channel(12 * spacing, 100, 10, WallKind::slips));
  EXPECT_NEAR(fall(world), g * 12.5 / 60, 0.02);
}

// exp(-nu k^2 t). Particles at the free surfaces lack pairs, so that it decays too slowly, by 5 to 9 % here.
TEST(Viscosity, DampsAShearWaveByItsRate) {
  constexpr float side = 20 * spacing, k = 2 * static_cast<float>(pi) / side;
  for (const float viscosity : {1.f, 10.f, 100.f}) {
    Object liquid = block({}, {side, 1.5f * side, 12 * spacing}, viscosity);
    for (const Vec3f& p : liquid.positions) liquid.velocities.push_back({0, 0.05f * std::cos(k * p.x), 0});
    World world(weightless(liquid, 10));
    const auto amplitude = [&] {
      double sum = 0;
      const std::vector<Vec3f> velocities = world.object(0).velocities();
      for (std::size_t i = 0; i < velocities.size(); ++i) {
        const Vec3f& p = liquid.positions[i];
        if (std::abs(p.y - 0.75f * side) < 0.25f * side)
          sum += static_cast<double>(velocities[i].y * std::cos(k * p.x));
      }
      return sum;
    };
    const double rate = static_cast<double>(viscosity) / 1000 * static_cast<double>(k * k), start = amplitude();
    for (int i = 0; i < 3; ++i) world.step(static_cast<float>(0.1 / rate));
    EXPECT_NEAR(std::log(start / amplitude()) / 0.3, 1, 0.1) << viscosity;
  }
}

struct Momentum {
  Vec3d linear{}, angular{};
  double size = 0, angular_size = 0;
};

Momentum momentum_of(const World& world) {
  Momentum sum;
  const std::vector<Vec3f> places = world.object(0).positions(), velocities = world.object(0).velocities();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3d x = in_double(places[i]), v = in_double(velocities[i]);
    sum.linear += v;
    sum.angular += cross(x, v);
    sum.size += std::sqrt(length_squared(v));
    sum.angular_size += std::sqrt(length_squared(x) * length_squared(v));
  }
  return sum;
}

double size_of(const Vec3d& a) { return std::sqrt(length_squared(a)); }

TEST(Viscosity, KeepsMomentumWhetherSolvedToTheEndOrNot) {
  for (const float viscosity : {1.f, 1e6f}) {
    Object liquid = block({-0.05f, -0.05f, -0.05f}, {0.05f, 0.05f, 0.05f}, viscosity);
    for (const Vec3f& p : liquid.positions)
      liquid.velocities.push_back({0.1f * std::sin(90 * p.y), 0.1f, std::abs(p.x)});
    World world(weightless(liquid, 10));
    const Momentum before = momentum_of(world);
    for (int i = 0; i < 10; ++i) world.step(frame_time);
    const Momentum after = momentum_of(world);
    EXPECT_LT(size_of(after.linear - before.linear), 1e-5 * before.size) << viscosity;
    EXPECT_LT(size_of(after.angular - before.angular), 3e-3 * before.angular_size) << viscosity;
    EXPECT_LT(after.size, 0.98 * before.size) << "nothing was damped";
  }
}

TEST(Viscosity, DoesNotResistRigidRotation) {
  Object liquid = block({-0.05f, -0.05f, -0.05f}, {0.05f, 0.05f, 0.05f}, 100);
  for (const Vec3f& p : liquid.positions) liquid.velocities.push_back(cross(Vec3f{0, 0, 1}, p));
  World world(weightless(liquid, 10));
  const double before = momentum_of(world).angular.z;
  for (int i = 0; i < 60; ++i) world.step(frame_time);
  EXPECT_NEAR(momentum_of(world).angular.z, before, 0.02 * before);
}

// A ball that flies into a drop goes with it: both together keep their momentum.
TEST(Viscosity, GivesItsMomentumToBodies) {
  const auto run = [](float viscosity) {
    std::vector<Vec3f> places;
    for (const Vec3f& p : fill_box({-0.08f, -0.08f, -0.08f}, {0.08f, 0.08f, 0.08f}, spacing))
      if (length_squared(p) > 0.035f * 0.035f) places.push_back(p);
    Scene scene = weightless(make_liquid(places, {.fluid = {.spacing = spacing, .viscosity = viscosity}}), 20);
    Solid ball;
    ball.shape = Sphere{0.03f};
    ball.density = 500;
    Object body = make_body({ball});
    body.velocities = {{0.2f, 0, 0}};
    scene.add(body);
    World world(scene);
    for (int i = 0; i < 30; ++i) world.step(frame_time);
    double momentum = 0;
    for (const Vec3f& v : world.object(0).velocities()) momentum += 1e-3 * static_cast<double>(v.x);
    const double mass = 500 * 4 / 3. * pi * 0.03 * 0.03 * 0.03;
    const double of_body = mass * static_cast<double>(world.object(1).velocities()[0].x);
    EXPECT_NEAR(momentum + of_body, mass * 0.2, 0.01 * mass * 0.2);
    return of_body / (momentum + of_body);
  };
  const double mass = 500 * 4 / 3. * pi * 0.03 * 0.03 * 0.03, both = mass + 1e-3 * (16 * 16 * 16 - 180);
  EXPECT_NEAR(run(20), mass / both, 0.2 * mass / both);
}

TEST(Viscosity, IsStableHoweverLarge) {
  Scene scene = channel(6 * spacing, 1e6f, 2);
  World world(scene);
  for (int i = 0; i < 30; ++i) {
    const Report report = world.step(frame_time);
    ASSERT_TRUE(report.ok()) << report.explain();
  }
  for (const Vec3f& v : world.object(0).velocities()) ASSERT_LT(length_squared(v), 0.01f * 0.01f);
}

/// Honey that falls on a plate and a ball, beside thinner liquid.
Scene mixed() {
  Scene scene = weightless(block({}, {0.06f, 0.1f, 0.06f}, 10, "honey"), 10);
  scene.gravity = {0, static_cast<float>(-g), 0};
  scene.add(block({0.06f, 0, 0}, {0.09f, 0.06f, 0.06f}, 0.1f, "oil"));
  scene.add(wall({0, -0.01f, 0}, {0, 0, 1}, 0, WallKind::holds));
  Solid ball;
  ball.shape = Sphere{0.02f};
  ball.density = 700;
  scene.add(make_body({ball}, {.position = {0.03f, 0.13f, 0.03f}}));
  return scene;
}

TEST(Viscosity, HasTheSameBitsOnAnyThreadsAndLevels) {
  const Scene scene = mixed();
  testing_support::expect_same_bits_on_any_threads_and_levels(scene, {8, frame_time});
}

TEST(Viscosity, GoesOnFromARestoredStateWithTheSameBits) {
  const Scene scene = mixed();
  testing_support::expect_same_bits_after_a_restore(scene, {4, frame_time});
}

TEST(Viscosity, OfSeveralIterationsIsThatOfOne) {
  constexpr float width = 12 * spacing;
  Scene scene = channel(width, 100, 10);
  scene.settings.iterations = 4;
  World world(scene);
  const double expected = poiseuille(width, 100);
  EXPECT_NEAR(fall(world), expected, 0.15 * expected);
}

TEST(Viscosity, DoesNotMoveFixedParticles) {
  Scene scene = weightless(block({}, {0.05f, 0.05f, 0.05f}, 10), 10);
  scene.gravity = {0, static_cast<float>(-g), 0};
  scene.objects[0].pins = {{0, {}}};
  const Vec3f first = scene.objects[0].positions[0];
  World world(scene);
  for (int i = 0; i < 10; ++i) world.step(frame_time);
  EXPECT_EQ(world.object(0).positions()[0], first);
}

TEST(Viscosity, OutOfRangeIsNamed) {
  EXPECT_NE(testing_support::refusal([] { make_liquid({{}}, {.fluid = {.viscosity = -1}}); }).find("viscosity"),
            std::string::npos);
  EXPECT_NE(testing_support::refusal([] {
              Scene scene = weightless(block({}, {0.05f, 0.05f, 0.05f}, 10), 10);
              scene.objects[0].fluid->viscosity = 1e7f;
              const World world(scene);
            }).find("viscosity"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
