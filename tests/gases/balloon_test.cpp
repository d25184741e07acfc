// Balloons: the air bears them up by Archimedes, and an ideal gas decides their volume.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pliant/error.h"
#include "pliant/gas.h"
#include "pliant/world.h"
#include "support/run.h"

namespace pliant {
namespace {

using testing_support::frame_time;
using testing_support::run;

TriangleMesh ball(float radius) {
  TriangleMesh mesh;
  constexpr int rings = 12, around = 20;
  const auto point = [&](float polar, float azimuth) {
    return Vec3f{radius * std::sin(polar) * std::cos(azimuth), radius * std::cos(polar),
                 radius * std::sin(polar) * std::sin(azimuth)};
  };
  constexpr float pi = 3.14159265f;
  mesh.positions.push_back({0, radius, 0});
  for (int r = 1; r < rings; ++r)
    for (int a = 0; a < around; ++a)
      mesh.positions.push_back(point(pi * static_cast<float>(r) / rings, 2 * pi * static_cast<float>(a) / around));
  mesh.positions.push_back({0, -radius, 0});
  const auto at = [&](int r, int a) { return 1 + (r - 1) * around + a % around; };
  const int last = static_cast<int>(mesh.positions.size()) - 1;
  for (int a = 0; a < around; ++a) {
    mesh.triangles.push_back({0, at(1, a + 1), at(1, a)});
    mesh.triangles.push_back({last, at(rings - 1, a), at(rings - 1, a + 1)});
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, a), at(r, a + 1), at(r + 1, a)});
      mesh.triangles.push_back({at(r, a + 1), at(r + 1, a + 1), at(r + 1, a)});
    }
  }
  return mesh;
}

double volume_of(const TriangleMesh& mesh) {
  double six = 0;
  const auto p = [&](int i) { return Vec3d{mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z}; };
  for (const auto& t : mesh.triangles) six += dot(cross(p(t[0]), p(t[1])), p(t[2]));
  return six / 6;
}

Fabric skin(float stretch_stiffness = 2000) {
  Fabric of;
  of.area_density = 0.03f;
  of.stretch_stiffness = stretch_stiffness;
  return of;
}

double mass_of(const Object& object) {
  double sum = 0;
  for (const float mass : object.masses) sum += static_cast<double>(mass);
  return sum;
}

Vec3d momentum(const World& world, const Object& object) {
  Vec3d sum{};
  const std::vector<Vec3f> velocities = world.object(0).velocities();
  for (std::size_t i = 0; i < velocities.size(); ++i)
    sum = sum + Vec3d{velocities[i].x, velocities[i].y, velocities[i].z} * static_cast<double>(object.masses[i]);
  return sum;
}

TEST(Balloon, IsBorneUpByArchimedes) {
  const TriangleMesh mesh = ball(0.2f);
  const double volume = volume_of(mesh);
  const GasOptions helium = gas_preset("helium");
  const auto mass = static_cast<float>(volume) * helium.fluid.density;  // as much as fits
  Object object = make_cloth(mesh, {.material = skin(1e5f), .volume = filled_with(helium, mass, volume)});
  Scene scene;
  scene.add(object);
  scene.settings.threads = 1;
  World world(scene);
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(world.step(frame_time).ok());
  const double weight = mass_of(object) * 9.81, lift = (1.204 - 0.166) * volume * 9.81;
  ASSERT_GT(lift, weight);
  EXPECT_NEAR(momentum(world, object).y, (lift - weight) * 0.5, 0.005 * (lift - weight));
  EXPECT_NEAR(momentum(world, object).x, 0, 1e-4 * lift);
  EXPECT_NEAR(world.object(0).enclosed_volume(), volume, 0.005 * volume);
}

TEST(Balloon, OfColdAirSinks) {
  const TriangleMesh mesh = ball(0.2f);
  GasOptions cold = gas_preset("air");
  cold.gas.temperature = 250;
  EXPECT_NEAR(filled_with(cold, 0.01f, 0.03).lift, 1.204 * (1 - 293.15 / 250), 1e-4);
}

TEST(Balloon, HasTheVolumeOfAnIdealGas) {
  const TriangleMesh mesh = ball(0.2f);
  const double volume = volume_of(mesh);
  const GasOptions helium = gas_preset("helium");
  const float mass = 0.5f * static_cast<float>(volume) * helium.fluid.density;  // half full, so that the skin is slack
  Object object = make_cloth(mesh, {.material = skin(), .volume = filled_with(helium, mass, volume)});
  Scene scene;
  scene.add(object);
  scene.settings.threads = 1;
  World world(scene);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(world.step(frame_time).ok());
  EXPECT_NEAR(world.object(0).enclosed_volume(), 0.5 * volume, 0.01 * volume);
  EXPECT_THROW(filled_with(helium, -1, volume), Error);
}

TEST(Balloon, WithoutLiftFalls) {
  const TriangleMesh mesh = ball(0.2f);
  Object object = make_cloth(mesh, {.material = skin(), .volume = Volume{}});
  Scene scene;
  scene.add(object);
  World world(scene);
  for (int i = 0; i < 30; ++i) world.step(frame_time);
  EXPECT_NEAR(momentum(world, object).y, -9.81 * 0.5 * mass_of(object), 1e-3 * mass_of(object));
}

/// A ball of rubber without gravity whose pressure is to change.
World blown_up(const Volume& volume) {
  Object object = make_cloth(ball(0.2f), {.material = skin(100), .volume = volume});
  object.damping = 5;
  Scene scene;
  scene.gravity = {};
  scene.add(object);
  scene.settings.threads = 1;
  return World(scene);
}

/// Expects a ball that grows by `rate` m^3/s to do so at an even speed.
void expect_speed(const World& world, double rate) {
  const double radius = std::cbrt(3 * world.object(0).enclosed_volume() / (4 * 3.14159265));
  const double wanted = rate / (4 * 3.14159265 * radius * radius);
  double sum = 0, largest = 0;
  const std::vector<Vec3f> velocities = world.object(0).velocities();
  for (const Vec3f& v : velocities) {
    const double speed = std::sqrt(static_cast<double>(dot(v, v)));
    sum += speed;
    largest = std::max(largest, speed);
  }
  EXPECT_NEAR(sum / static_cast<double>(velocities.size()), wanted, 0.2 * wanted);
  EXPECT_LT(largest, 1.5 * wanted);
}

TEST(Balloon, FollowsTheKeyframesOfItsPressure) {
  Volume volume;
  volume.keyframes = {{0.5f, 1}, {1, 1.4f}, {2, 0.8f}};
  World world = blown_up(volume);
  const double rest = volume_of(ball(0.2f));
  run(world, 30);
  EXPECT_NEAR(world.object(0).enclosed_volume(), rest, 1e-3 * rest);
  run(world, 15);
  EXPECT_NEAR(world.object(0).enclosed_volume(), 1.2 * rest, 0.01 * rest);
  expect_speed(world, 0.8 * rest);
  run(world, 15);
  EXPECT_NEAR(world.object(0).enclosed_volume(), 1.4 * rest, 0.01 * rest);
  World other = blown_up(volume);
  other.restore(world.state());
  run(other, 90);
  run(world, 90);
  EXPECT_NEAR(world.object(0).enclosed_volume(), 0.8 * rest, 0.005 * rest);
  EXPECT_EQ(other.state_hash(), world.state_hash());
}

TEST(Balloon, LeaksByAnExponential) {
  Volume volume;
  volume.pressure = 1.4f;
  volume.leak = 1;
  World world = blown_up(volume);
  const double rest = volume_of(ball(0.2f));
  run(world, 60);
  EXPECT_NEAR(world.object(0).enclosed_volume(), (1 + 0.4 * std::exp(-1.0)) * rest, 0.005 * rest);
  run(world, 240);
  EXPECT_NEAR(world.object(0).enclosed_volume(), (1 + 0.4 * std::exp(-5.0)) * rest, 0.002 * rest);
}

TEST(Balloon, RefusesPressuresOutOfOrder) {
  Volume volume;
  volume.keyframes = {{1, 1}, {1, 1.4f}};
  try {
    blown_up(volume);
    FAIL() << "taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("volume, keyframe 1: is not after the previous one"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pliant
