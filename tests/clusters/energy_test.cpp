// Clusters make no energy and no momentum, and their rest shape is the given one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "math/vector.h"
#include "pliant/cluster.h"
#include "pliant/world.h"
#include "support/run.h"

namespace pliant {
namespace {

using testing_support::run;
using Vec3d = Vec3<double>;

constexpr double gravity = 9.81;

Object block(int n, float spacing, float mass) {
  Object object;
  object.name = "block";
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y)
      for (int z = 0; z < n; ++z) object.positions.push_back(spacing * Vec3f{float(x), float(y), float(z)});
  object.masses.assign(object.positions.size(), mass);
  return object;
}

/// All particles as one cluster, whose rest shape is where they are.
void make_cluster(Object& object, const ClusterOptions& options) {
  std::vector<int> all;
  for (std::size_t i = 0; i < object.positions.size(); ++i) all.push_back(static_cast<int>(i));
  add_cluster(object, all, options);
  object.clusters[0].rest = object.positions;
}

/// A cube of 8 particles that spins in free flight.
Scene spinning(const ClusterOptions& options) {
  Object cube = block(2, 0.1f, 0.1f);
  make_cluster(cube, options);
  for (const Vec3f& p : cube.positions) {
    const Vec3f q = p - Vec3f{0.05f, 0.05f, 0.05f};
    cube.velocities.push_back({5 * q.z - 3 * q.y, 3 * q.x - 2 * q.z, 2 * q.y - 5 * q.x});
  }
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  scene.add(std::move(cube));
  return scene;
}

/// A block of 27 particles that falls half a metre onto a plane, on a face or on an edge.
Scene dropped(const ClusterOptions& options, bool is_tilted) {
  Object cube = block(3, 0.05f, 0.03f);
  make_cluster(cube, options);
  cube.thickness = 0.01f;
  for (Vec3f& p : cube.positions) {
    if (is_tilted) p = {0.8f * p.x - 0.6f * p.y, 0.6f * p.x + 0.8f * p.y, p.z};
    p.y += 0.5f;
  }
  Scene scene;
  scene.gravity = {0, -static_cast<float>(gravity), 0};
  scene.settings.threads = 1;
  scene.add(std::move(cube));
  scene.add(Collider{.name = "floor", .shape = Plane{}});
  return scene;
}

/// Kinetic energy, and potential energy in gravity above y = 0 [J]. That of the cluster is left out: it is 0 at the
/// start, and never below.
double energy(const World& world, const Scene& scene) {
  const State& state = world.state();
  double sum = 0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const double mass = static_cast<double>(scene.objects[0].masses[i]);
    const Vec3d v = convert<double>(world.object(world.objects()[0]).velocities()[i]);
    sum += mass * (dot(v, v) / 2 - static_cast<double>(scene.gravity.y) * static_cast<double>(state.positions[i].y));
  }
  return sum;
}

/// The largest energy after any frame over that of the start.
double most_energy(const Scene& scene, int frames) {
  World world(scene);
  const double start = energy(world, scene);
  double most = 0;
  for (int frame = 0; frame < frames; ++frame) {
    run(world, 1);
    most = std::max(most, energy(world, scene));
  }
  return most / start;
}

TEST(ClusterEnergy, NeverGrows) {
  for (const Cluster::Mode mode : {Cluster::Mode::linear, Cluster::Mode::quadratic})
    for (const float share : {0.5f, 0.8f, 1.f})
      for (const float compliance : {2e-4f, 1e-3f, 3e-3f, 1e-2f}) {
        const ClusterOptions options{.mode = mode, .share = share, .stiffness = Stiffness::compliance(compliance)};
        const auto where = [&] { return testing::Message() << int(mode) << ", " << share << ", " << compliance; };
        EXPECT_LT(most_energy(spinning(options), 300), 1.0001) << where();
        for (const bool is_tilted : {false, true})
          EXPECT_LT(most_energy(dropped(options, is_tilted), 120), 1.0001) << where();
      }
}

TEST(ClusterEnergy, DampingOnlyTakes) {
  // With share 1 and soft, so that the spin draws the cube out and the rate of C has the sign of its motion no more.
  for (const float damping : {8.f, 40.f})
    for (const float share : {0.8f, 1.f}) {
      const ClusterOptions options{
          .mode = Cluster::Mode::linear, .share = share, .stiffness = Stiffness::compliance(0.03f, damping)};
      EXPECT_LT(most_energy(spinning(options), 300), 1.0001) << damping << ", " << share;
    }
}

/// `count` particles in general position in a box of 0.1 m x 0.05 m x 0.1 m.
Object cloud(int count) {
  Object object;
  object.name = "cloud";
  std::mt19937 numbers(5);
  const auto next = [&] { return static_cast<float>(numbers() >> 8) / 16777216.f; };
  for (int i = 0; i < count; ++i) {
    const float x = next(), y = next(), z = next();
    object.positions.push_back({0.1f * x, 0.05f * y, 0.1f * z});
  }
  object.masses.assign(object.positions.size(), 0.1f);
  return object;
}

TEST(ClusterEnergy, AnyNumberOfParticlesRestsInTheGivenShape) {
  for (const Cluster::Mode mode : {Cluster::Mode::rigid, Cluster::Mode::linear, Cluster::Mode::quadratic})
    for (int count = 2; count <= 12; ++count) {
      Object object = cloud(count);
      make_cluster(object, {.mode = mode});
      const std::vector<Vec3f> rest = object.positions;
      Scene scene;
      scene.gravity = {};
      scene.settings.threads = 1;
      scene.add(std::move(object));
      World world(scene);
      run(world, 10);
      const std::vector<Vec3f> now = world.object(world.objects()[0]).positions();
      for (std::size_t i = 0; i < rest.size(); ++i)
        EXPECT_LT(length(now[i] - rest[i]), 1e-6f) << int(mode) << ", " << count;
    }
}

TEST(ClusterEnergy, AMirroredStartMakesNoAngularMomentum) {
  for (const Cluster::Mode mode : {Cluster::Mode::rigid, Cluster::Mode::linear, Cluster::Mode::quadratic}) {
    Object cube = block(2, 0.1f, 0.1f);
    make_cluster(cube, {.mode = mode, .stiffness = Stiffness::compliance(1e-3f, 30)});
    for (Vec3f& p : cube.positions) p.x = -p.x;
    Scene scene;
    scene.gravity = {};
    scene.settings.threads = 1;
    scene.add(std::move(cube));
    World world(scene);
    double fastest = 0;
    for (int frame = 0; frame < 30; ++frame) {
      run(world, 1);
      const std::vector<Vec3f> at = world.object(world.objects()[0]).positions();
      const std::vector<Vec3f> v = world.object(world.objects()[0]).velocities();
      Vec3d momentum{};  // about the centre, which rests
      for (std::size_t i = 0; i < at.size(); ++i) {
        const Vec3d arm = convert<double>(at[i]) - Vec3d{-0.05, 0.05, 0.05};
        momentum += 0.1 * cross(arm, convert<double>(v[i]));
        fastest = std::max(fastest, double(length(v[i])));
      }
      EXPECT_LT(length(momentum), 1e-6) << int(mode) << ", " << frame;  // of 0.13 that such speeds could have
    }
    EXPECT_GT(fastest, 0.5);
  }
}

}  // namespace
}  // namespace pliant
