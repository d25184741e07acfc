// Energy and momentum where the number of substeps follows the State and changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "world/run_time_support.h"

namespace pliant {
namespace {

using namespace testing_support;

#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__)
constexpr int drops_apart = 1;
#else
constexpr int drops_apart = 12;  // of the sixty, debug builds and sanitizers run every twelfth
#endif

/// A sheet of 1 m just above the top of a ball, which it meets at `speed` [m/s].
Scene drop(int n, float height, float speed, float radius) {
  Scene scene;
  ClothOptions options;
  options.stretch = Stiffness::compliance(0);
  Object sheet = sheet_at("sheet", {0, radius + 0.02f + height, 0}, n, 1, options);
  sheet.thickness = 0.002f;
  sheet.velocities.assign(sheet.positions.size(), {0, -speed, 0});
  scene.add(sheet);
  Collider ball;
  ball.shape = Sphere{radius};
  scene.add(ball);
  scene.settings.sweep = Sweep::chains;
  return scene;
}

double energy(const World& world) { return world.measure().kinetic_energy() + world.measure().potential_energy(); }

/// The most by which kinetic and gravitational energy rise above an earlier minimum [J/kg].
double energy_gain(const Scene& scene, int frames) {
  World world(scene);
  State falls = world.state();
  falls.substeps = {12};  // as after a fall
  world.restore(falls);
  double mass = 0, gain = 0, least = energy(world);
  for (const float m : scene.objects[0].masses) mass += static_cast<double>(m);
  for (int frame = 0; frame < frames; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    gain = std::max(gain, (energy(world) - least) / mass);
    least = std::min(least, energy(world));
  }
  return gain;
}

/// The most by which the energy of a sheet rises that swings down from two corners, held by rigid attachments.
double gain_of_attached(const std::vector<int>& corners, Sweep sweep, Overstretch& worst) {
  Scene scene;
  Object sheet = sheet_at("sheet", {}, 40, 1, {});
  for (const int p : corners)
    sheet.attachments.push_back({p, sheet.positions[static_cast<std::size_t>(p)], {}, Stiffness::rigid()});
  scene.add(sheet);
  scene.settings.sweep = sweep;
  World world(scene);
  double mass = 0, gain = 0, least = energy(world);
  for (const float m : scene.objects[0].masses) mass += static_cast<double>(m);
  for (int frame = 0; frame < 60; ++frame) {
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok());
    worst = report.worst_overstretch.overstretch;
    for (const int p : worst.particles) EXPECT_LT(p, 1600) << "no target of an attachment";
    gain = std::max(gain, (energy(world) - least) / mass);
    least = std::min(least, energy(world));
  }
  return gain;
}

// Chains pulled attached corners off their targets in each substep: 2 to 3 J/kg.
TEST(SubstepEnergy, IsNotGainedByClothThatHangsByAttachments) {
  Overstretch worst;
  EXPECT_LT(gain_of_attached({0, 39}, Sweep::automatic, worst), 0.01);
  EXPECT_LT(worst.p99, 0.01);
  EXPECT_LT(worst.largest, 0.05);
  EXPECT_LT(gain_of_attached({0}, Sweep::automatic, worst), 0.01);
  EXPECT_LT(worst.p99, 0.02);
  EXPECT_LT(gain_of_attached({0}, Sweep::chains, worst), 0.05);
  EXPECT_LT(gain_of_attached({0, 39}, Sweep::chains, worst), 0.3);
}

TEST(SubstepEnergy, IsNotGainedAtImpacts) {
  for (int i = 0; i < 60; i += drops_apart)
    EXPECT_LT(energy_gain(drop(48, 0.0007f * static_cast<float>(i), 5, 0.15f), 6), 0.01) << i;
}

TEST(SubstepEnergy, IsNotGainedAtImpactsOfCoarseCloth) {
  for (int i = 0; i < 60; i += drops_apart)
    EXPECT_LT(energy_gain(drop(24, 0.0007f * static_cast<float>(i), 5, 0.15f), 6), 0.01) << i;
}

/// A collider that moves elsewhere does no work.
TEST(SubstepEnergy, IsNotGainedWhereAnotherColliderMoves) {
  for (int i = 0; i < 60; i += 6) {
    Scene scene = drop(32, 0.0007f * static_cast<float>(i), 5, 0.15f);
    Collider far;
    far.shape = Sphere{1};
    far.position = {50, 0, 0};
    far.motion = straight({1, 0, 0}, 1);
    scene.add(far);
    EXPECT_LT(energy_gain(scene, 6), 0.01) << i;
  }
}

/// Frames of one set, and of two that run side by side, are stopped at `share` of each; the energy gained [J/kg].
double energy_gain_where_stopped(int sets, float height, float share) {
  Scene scene;
  for (int i = 0; i < sets; ++i) {
    const Scene one = drop(32, height, 5, 0.15f);
    scene.add(one.objects[0]);
    scene.add(one.colliders[0]);
    const Vec3f aside{5 * static_cast<float>(i), 0, 0};
    for (Vec3f& p : scene.objects.back().positions) p += aside;
    scene.colliders.back().position += aside;
  }
  std::atomic<bool> flag{false};
  std::atomic<float> at{0};
  const auto ask = [&](const Vec3f&, const Vec3f&, float, float time) {
    if (time >= at) flag = true;
    return Vec3f{};
  };
  scene.forces.emplace_back(ask, true);
  scene.settings.sweep = Sweep::chains;
  World world(scene);
  State falls = world.state();
  falls.substeps.assign(static_cast<std::size_t>(sets), 12);
  world.restore(falls);
  world.stop_when(&flag);
  double mass = 0, gain = 0, least = energy(world);
  for (const Object& object : scene.objects)
    for (const float m : object.masses) mass += static_cast<double>(m);
  for (int step = 0; step < 1000 && world.state().time < 6 * double(dt); ++step) {
    flag = false;
    at = static_cast<float>(world.state().time + double(share) * double(dt));
    world.step(dt);
    gain = std::max(gain, (energy(world) - least) / mass);
    least = std::min(least, energy(world));
  }
  return gain;
}

TEST(SubstepEnergy, IsNotGainedWhereFramesAreStopped) {
  for (const int sets : {1, 2})
    for (int i = 0; i < 60; i += 20)
      EXPECT_LT(energy_gain_where_stopped(sets, 0.0007f * static_cast<float>(i), 0.3f), 0.01) << sets << " sets, " << i;
}

/// A small ball moves few constraints, so most of the impact happens before they demand substeps.
TEST(SubstepEnergy, IsNotGainedAtImpactsOnASmallBall) {
  for (int i = 0; i < 30; i += drops_apart)
    EXPECT_LT(energy_gain(drop(48, 0.0014f * static_cast<float>(i), 5, 0.05f), 6), 0.01) << i;
}

/// The angular momentum of an object's particles about the origin [kg m^2/s].
Vec3<double> angular_momentum(const World& world, ObjectId object) {
  Vec3<double> sum{};
  const auto positions = world.object(object).positions_in_storage_order(),
             velocities = world.object(object).velocities_in_storage_order();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Record &p = positions[i], &u = velocities[i];
    const Vec3<double> x{double(p.x), double(p.y), double(p.z)}, v{double(u.x), double(u.y), double(u.z)};
    sum += Vec3<double>{x.y * v.z - x.z * v.y, x.z * v.x - x.x * v.z, x.x * v.y - x.y * v.x} * (1 / double(p.w));
  }
  return sum;
}

double norm(const Vec3<double>& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

/// A free sheet of which a disc is fast: substeps follow suddenly, and only a share of the corrections becomes
/// velocity.
TEST(SubstepEnergy, ChangesOfSubstepsConserveMomentum) {
  Scene scene = drop(48, 0, 0, 0.15f);
  scene.colliders.clear();
  scene.gravity = {};
  Object& sheet = scene.objects[0];
  for (std::size_t i = 0; i < sheet.positions.size(); ++i) {
    const Vec3f& p = sheet.positions[i];
    if (p.x * p.x + p.z * p.z < 0.04f) sheet.velocities[i] = {1, 5, 0};
  }
  World world(scene);
  State rests = world.state();
  rests.substeps = {12};
  world.restore(rests);
  const Vec3<double> before = momentum(world, {0}), turning_before = angular_momentum(world, {0});
  for (int frame = 0; frame < 10; ++frame) ASSERT_TRUE(world.step(dt).ok());
  const double size = norm(before);
  EXPECT_GT(size, 0.05);
  EXPECT_LT(norm(momentum(world, {0}) - before), 1e-6 * size);
  // Fixed substeps change it as much: corrections along chains follow edges that turn meanwhile.
  EXPECT_LT(norm(angular_momentum(world, {0}) - turning_before), 4e-3 * size);
}

/// Each frame starts with another number of substeps than the one before it ended with. The fall must not depend on it.
TEST(SubstepEnergy, FreeFallDoesNotSeeChangesOfSubsteps) {
  Scene scene = drop(24, 0, 0, 0.15f);
  scene.colliders.clear();
  World world(scene);
  const std::vector<Vec3f> start = world.object({0}).positions();
  constexpr int frames = 30;
  for (int frame = 0; frame < frames; ++frame) {
    State state = world.state();
    state.substeps = {frame % 3 == 0 ? 100.f : 12.f};
    world.restore(state);
    ASSERT_TRUE(world.step(dt).ok());
  }
  const double time = frames * static_cast<double>(dt), fall = 0.5 * 9.81 * time * time;
  const std::vector<Vec3f> at = world.object({0}).positions(), v = world.object({0}).velocities();
  for (std::size_t i = 0; i < at.size(); ++i) {
    EXPECT_NEAR(v[i].y, -9.81 * time, 1e-5 * 9.81 * time);
    EXPECT_NEAR(std::hypot(v[i].x, v[i].z), 0, 1e-4);
    const double way = static_cast<double>(start[i].y) - static_cast<double>(at[i].y);
    const double of_euler = 0.5 * 9.81 * time * static_cast<double>(dt);  // symplectic Euler falls by g t h / 2 farther
    EXPECT_GT(way, fall + of_euler / 100 - 1e-6);
    EXPECT_LT(way, fall + of_euler / 12 + 1e-6);
  }
}

}  // namespace
}  // namespace pliant
