// Tests bodies that spin fast: Euler's equations keep energy and angular momentum, whatever the angle per substep, and
// contact brings none.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "math/quat.h"
#include "pliant/body.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// Energy [J] and the size of angular momentum [kg m^2/s] of a body that spins by w about its principal axes.
std::pair<double, double> energy_and_momentum(const Vec3f& inertia, const Record& w) {
  const double x = double(inertia.x) * double(w.x), y = double(inertia.y) * double(w.y),
               z = double(inertia.z) * double(w.z);
  return {0.5 * (x * double(w.x) + y * double(w.y) + z * double(w.z)), std::sqrt(x * x + y * y + z * z)};
}

void expect_steady(const Solid& solid, const Vec3f& spin, int frames) {
  BodyOptions options;
  options.angular_velocity = spin;
  const Object body = make_body({solid}, options);
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.settings.threads = 1;
  scene.add(body);
  World world(scene);
  const auto now = [&] {
    return energy_and_momentum(body.frames[0].inertia, world.state().frames.angular_velocities[0]);
  };
  const auto [energy, momentum] = now();
  for (int frame = 0; frame < frames; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
  EXPECT_NEAR(now().first / energy, 1, 1e-4) << spin.y;
  EXPECT_NEAR(now().second / momentum, 1, 1e-4) << spin.y;
}

/// A coin that spins by up to 0.98 rad a substep. The implicit midpoint rule in two rounds of fixed-point iteration
/// tripled its energy in 10 s at 200 rad/s.
TEST(SpinningBody, OfACoinKeepsItsEnergy) {
  for (const float spin : {20.f, 120.f, 200.f, 300.f, 470.f})
    expect_steady({Cylinder{0.1f, 0.01f}}, {1, spin, 0.5f}, 600);
}

/// A plate about its middle axis turns over again and again.
TEST(SpinningBody, OfATumblingPlateKeepsItsEnergy) {
  for (const float spin : {5.f, 50.f, 200.f}) expect_steady({Box{{0.3f, 0.1f, 0.02f}}}, {0.01f, spin, 0.02f}, 600);
}

/// A needle turns about its axis by 6 rad a substep while it tumbles: angular momentum stays in the world.
TEST(SpinningBody, OfANeedleKeepsItsAngularMomentum) {
  BodyOptions options;
  options.angular_velocity = {5, 3000, 0};
  const Object body = make_body({{Cylinder{0.002f, 0.5f}}}, options);
  const Vec3f inertia = body.frames[0].inertia;
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.add(body);
  World world(scene);
  const auto momentum = [&] {
    const Record w = world.state().frames.angular_velocities[0], q = world.state().frames.orientations[0];
    return rotate(Quatf{q.x, q.y, q.z, q.w}, Vec3f{inertia.x * w.x, inertia.y * w.y, inertia.z * w.z});
  };
  const Vec3f start = momentum();
  for (int frame = 0; frame < 120; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
  EXPECT_LT(length(momentum() - start), 1e-3f * length(start));
}

/// A ball that slides and spins about the vertical rolls straight on with 5/7 of its speed (Coriolis 1835): friction
/// acts against the sliding of the lowest point, which the spin does not move.
TEST(SpinningBody, OfABallDoesNotTurnItsPath) {
  for (const float spin : {0.f, 10.f, 60.f, 300.f}) {
    Scene scene;
    scene.add(Collider{});
    scene.colliders[0].static_friction = scene.colliders[0].kinetic_friction = 0.3f;
    BodyOptions options;
    options.position = {0, 0.1f, 0};
    options.velocity = {5, 0, 0};
    options.angular_velocity = {0, spin, 0};
    Object ball = make_body({{Sphere{0.1f}}}, options);
    ball.static_friction = ball.kinetic_friction = 0.3f;
    scene.add(ball);
    World world(scene);
    for (int frame = 0; frame < 120; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
    EXPECT_NEAR(world.object(0).velocities()[0].x, 5 * 5 / 7.f, 2e-3f) << spin;
    EXPECT_NEAR(world.object(0).positions()[0].z, 0, 1e-3f) << spin;
  }
}

/// A wheel of 0.1 m that rolls goes straight on at any speed: its turn about its axis moves no surface.
TEST(SpinningBody, OfAWheelKeepsItsPath) {
  const float half = std::sqrt(0.5f);
  for (const float spin : {10.f, 30.f, 50.f}) {
    Scene scene;
    scene.add(Collider{});
    scene.colliders[0].static_friction = scene.colliders[0].kinetic_friction = 1;
    BodyOptions options;
    options.position = {0, 0.1f, 0};
    options.rotation = {half, 0, 0, half};
    options.velocity = {0.1f * spin, 0, 0};
    options.angular_velocity = {0, 0, -spin};
    Object wheel = make_body({{Cylinder{0.1f, 0.1f}}}, options);
    wheel.static_friction = wheel.kinetic_friction = 1;
    scene.add(wheel);
    World world(scene);
    for (int frame = 0; frame < 120; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
    EXPECT_NEAR(world.object(0).velocities()[0].x, 0.1f * spin, 1e-3f * spin) << spin;
    EXPECT_NEAR(world.object(0).positions()[0].z, 0, 1e-2f) << spin;
  }
}

/// The energy of the bodies of an object over the mass of one [J/kg]; half a kick of gravity is not in the velocities
/// of symplectic Euler.
double energy_of(const Object& object, const World& world, double kick) {
  double sum = 0;
  for (const ObjectBody& body : object.bodies) {
    const Vec3f x = world.object(0).positions()[static_cast<std::size_t>(body.particle)],
                v = world.object(0).velocities()[static_cast<std::size_t>(body.particle)];
    const auto frame = static_cast<std::size_t>(body.frame);
    const double mass = double(object.masses[static_cast<std::size_t>(body.particle)]), up = double(v.y) - 0.5 * kick;
    sum +=
        0.5 * (double(v.x) * double(v.x) + up * up + double(v.z) * double(v.z)) + 9.81 * double(x.y) +
        energy_and_momentum(object.frames[frame].inertia, world.state().frames.angular_velocities[frame]).first / mass;
  }
  return sum;
}

/// Rods of 4 mm and 1 m that are thrown down with spin: the tip that lands turns them faster about their axis than a
/// substep can show.
TEST(SpinningBody, OfRodsThatLandBringsNoEnergy) {
  Scene scene;
  scene.settings.threads = 1;
  scene.add(Collider{});
  Object rods;
  for (int i = 0; i < 25; ++i) {
    const auto x = static_cast<float>(i % 5), z = static_cast<float>(i / 5), turn = 0.7f * static_cast<float>(i);
    BodyOptions options;
    options.position = {3 * x, 1, 3 * z};
    options.rotation = {std::sin(turn) * 0.6f, 0, std::sin(turn) * 0.8f, std::cos(turn)};
    options.angular_velocity = {3, 20, 9};
    add_body(rods, {{Cylinder{0.002f, 0.5f}}}, options);
  }
  scene.add(rods);
  World world(scene);
  double before = energy_of(rods, world, 0);
  const double start = before;
  for (int frame = 0; frame < 240; ++frame) {
    ASSERT_TRUE(world.step(1.f / 60).ok());
    const double now = energy_of(rods, world, 9.81 / 480);
    EXPECT_LT(now, before + 0.01 * start) << frame;
    before = now;
  }
}

/// A ball of radius 0.1 m that rolls, with moments of inertia of its own [kg m^2].
World rolling_ball(const Vec3f& moments, const Vec3f& spin) {
  Scene scene;
  scene.add(Collider{});
  scene.colliders[0].static_friction = scene.colliders[0].kinetic_friction = 0.5f;
  BodyOptions options;
  options.position = {0, 0.1f, 0};
  options.velocity = {5, 0, 0};
  options.angular_velocity = spin;
  Object ball = make_body({{Sphere{0.1f}}}, options);
  ball.static_friction = ball.kinetic_friction = 0.5f;
  ball.masses[0] = 1;
  ball.frames[0].inertia = moments;
  scene.add(ball);
  return World(scene);
}

/// A ball that is loaded unevenly wobbles as it rolls, and gains no energy: its solid is round, its inertia is not.
TEST(SpinningBody, OfABallWithUnevenInertiaKeepsItsEnergy) {
  const Vec3f moments{0.006f, 0.003f, 0.0035f};
  World world = rolling_ball(moments, {1, 3, -50});
  const auto energy = [&] {
    const Vec3f v = world.object(0).velocities()[0];
    return 0.5 * double(length_squared(v)) +
           energy_and_momentum(moments, world.state().frames.angular_velocities[0]).first;
  };
  const double start = energy();
  for (int frame = 0; frame < 600; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
  EXPECT_LT(energy(), 1.01 * start);
}

/// Rotation about an axis of infinite inertia is locked, of round bodies too.
TEST(SpinningBody, OfABallDoesNotTurnALockedAxis) {
  World world = rolling_ball({std::numeric_limits<float>::infinity(), 0.004f, 0.004f}, {0, 30, 0});
  for (int frame = 0; frame < 120; ++frame) {
    ASSERT_TRUE(world.step(1.f / 60).ok());
    ASSERT_NEAR(world.state().frames.angular_velocities[0].x, 0, 1e-4f) << frame;  // rounding of 30 rad/s
  }
}

/// A body that spins elsewhere, so that contacts are found again within frames, changes nothing for one that rides on a
/// mesh that moves.
TEST(SpinningBody, DoesNotDisturbARideOnAMesh) {
  Scene scene;
  scene.add(Collider{});
  MeshCollider platform;
  platform.mesh.positions = {{-3, 1, -3}, {3, 1, -3}, {-3, 1, 3}, {3, 1, 3}};
  platform.mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
  platform.static_friction = platform.kinetic_friction = 1;
  platform.motion.keyframes = {{0, {0, 0, 0}, {}}, {10, {20, 0, 0}, {}}};
  scene.add(platform);
  BodyOptions rider, spinner;
  rider.position = {0, 1.1f, 0};
  rider.velocity = {2, 0, 0};
  spinner.position = {0, 0.1f, 20};
  spinner.angular_velocity = {0, 60, 0};
  for (const BodyOptions& options : {rider, spinner}) {
    Object box = make_body({{Box{{0.1f, 0.1f, 0.1f}}}}, options);
    box.static_friction = box.kinetic_friction = 1;
    scene.add(box);
  }
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
  EXPECT_NEAR(world.object(0).velocities()[0].x, 2, 1e-3f);
  EXPECT_NEAR(world.object(0).positions()[0].x, 2, 1e-3f);
}

}  // namespace
}  // namespace pliant
