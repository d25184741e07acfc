// Shape matching against known answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "math/vector.h"
#include "pliant/cluster.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/grains.h"
#include "pliant/liquid.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "support/run.h"
#include "support/scenes.h"

namespace pliant {
namespace {

struct Vec {
  double x = 0, y = 0, z = 0;
};

Vec cross(const Vec& a, const Vec& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

/// A lattice of n x n x n particles of 1 g, centred at the origin.
Object lattice(int n, float spacing) {
  Object object;
  object.name = "block";
  const float middle = 0.5f * static_cast<float>(n - 1);
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y)
      for (int z = 0; z < n; ++z)
        object.positions.push_back(spacing * Vec3f{float(x) - middle, float(y) - middle, float(z) - middle});
  object.masses.assign(object.positions.size(), 0.001f);
  return object;
}

std::vector<int> all_of(const Object& object) {
  std::vector<int> all;
  for (int i = 0; i < static_cast<int>(object.positions.size()); ++i) all.push_back(i);
  return all;
}

/// A scene without gravity of one object; all its particles are one cluster.
Scene free_scene(Object object, const ClusterOptions& options, int substeps = 20) {
  add_cluster(object, all_of(object), options);
  object.clusters[0].rest = object.positions;
  Scene scene;
  scene.gravity = {};
  scene.settings.substeps = substeps;
  scene.settings.threads = 1;
  scene.add(std::move(object));
  return scene;
}

using testing_support::run;

/// The angular momentum about the centre of particles of one mass, over that mass [m^2/s].
Vec spin_of(const World& world) {
  const State& state = world.state();
  const std::size_t count = state.positions.size();
  Vec c, v, sum;
  for (std::size_t i = 0; i < count; ++i) {
    c = {c.x + state.positions[i].x, c.y + state.positions[i].y, c.z + state.positions[i].z};
    v = {v.x + state.velocities[i].x, v.y + state.velocities[i].y, v.z + state.velocities[i].z};
  }
  const double n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto &p = state.positions[i], &u = state.velocities[i];
    const Vec one = cross({p.x - c.x / n, p.y - c.y / n, p.z - c.z / n}, {u.x - v.x / n, u.y - v.y / n, u.z - v.z / n});
    sum = {sum.x + one.x, sum.y + one.y, sum.z + one.z};
  }
  return sum;
}

/// The root mean square difference of all distances between particles from those of the rest shape, over the latter's.
double misshape(const std::vector<Vec3f>& now, const std::vector<Vec3f>& rest) {
  double difference = 0, whole = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double is = double(length(now[i] - now[j])), was = double(length(rest[i] - rest[j]));
      difference += (is - was) * (is - was);
      whole += was * was;
    }
  return std::sqrt(difference / whole);
}

TEST(ShapeMatching, ARigidClusterSpinsAndFliesOn) {
  Object block = lattice(3, 0.1f);
  const double omega = 4;
  for (const Vec3f& p : block.positions)
    block.velocities.push_back(Vec3f{1, 0, 0} + float(omega) * Vec3f{-p.y, p.x, 0});
  const std::vector<Vec3f> rest = block.positions;
  const Scene scene = free_scene(block, {});
  World world(scene);
  const Vec before = spin_of(world);
  run(world, 60);
  const Vec after = spin_of(world);
  EXPECT_NEAR(after.z / before.z, 1, 2e-5);
  EXPECT_LT(std::hypot(after.x, after.y), 2e-5 * before.z);
  const std::vector<Vec3f> now = world.object(world.objects()[0]).positions();
  EXPECT_LT(misshape(now, rest), 1e-4);
  Vec centre;
  for (const Vec3f& p : now) centre = {centre.x + double(p.x), centre.y + double(p.y), centre.z + double(p.z)};
  EXPECT_NEAR(centre.x / static_cast<double>(now.size()), 1, 1e-5);
  const Vec3f arm = now[26] - now[0];  // a diagonal, (1, 1, 1) at the start
  const double turned = std::atan2(double(arm.y), double(arm.x)) - std::atan2(1., 1.);
  EXPECT_NEAR(std::remainder(turned - omega, 2 * 3.14159265358979), 0, 0.005 * omega);
}

/// The time from one passage of particle 0 through its rest distance to the second next [s].
double period(Scene scene) {
  Object& block = scene.objects[0];
  const double rest = double(length(block.positions[0]));
  for (Vec3f& p : block.positions) p = 1.1f * p;
  World world(scene);
  std::vector<double> passages;
  double before = 0.1 * rest;
  for (int frame = 1; passages.size() < 3 && frame < 600; ++frame) {
    run(world, 1);
    const double now = double(length(world.object(world.objects()[0]).positions()[0])) - rest;
    if ((now > 0) != (before > 0)) passages.push_back((frame - now / (now - before)) / 60);
    before = now;
  }
  return passages.size() == 3 ? passages[2] - passages[0] : 0;
}

TEST(ShapeMatching, ComplianceIsTheInverseSquareOfAFrequency) {
  const double alpha = 0.01, expected = 2 * 3.14159265358979 * std::sqrt(alpha);
  Scene scene = free_scene(lattice(3, 0.1f), {.stiffness = Stiffness::compliance(float(alpha))});
  EXPECT_NEAR(period(scene), expected, 0.01 * expected);
  scene.settings.iterations = 5;
  EXPECT_NEAR(period(scene), expected, 0.01 * expected);
  for (float& mass : scene.objects[0].masses) mass *= 50;
  EXPECT_NEAR(period(scene), expected, 0.01 * expected);
}

TEST(ShapeMatching, DampingTakesThePulseButNotTheSpin) {
  // A damped oscillator of alpha and beta: x'' = -(x + alpha beta x') / alpha, so amplitudes fall by exp(-beta t / 2).
  Object block = lattice(3, 0.1f);
  for (const Vec3f& p : block.positions) block.velocities.push_back(4.f * Vec3f{-p.y, p.x, 0});
  Scene scene = free_scene(block, {.stiffness = Stiffness::compliance(0.0001f, 200)});
  World world(scene);
  const double before = spin_of(world).z;
  run(world, 60);
  EXPECT_NEAR(spin_of(world).z / before, 1, 1e-4);
}

/// How far particles of a scene without forces move in half a second from where they are put [m].
double restores(const ClusterOptions& options, Vec3f (*place)(const Vec3f&)) {
  Scene scene = free_scene(lattice(4, 0.1f), options);
  std::vector<Vec3f> start;
  for (Vec3f& p : scene.objects[0].positions) start.push_back(p = place(p));
  World world(scene);
  run(world, 30);
  const std::vector<Vec3f> now = world.object(world.objects()[0]).positions();
  double largest = 0;
  for (std::size_t i = 0; i < now.size(); ++i) largest = std::max(largest, double(length(now[i] - start[i])));
  return largest;
}

Vec3f sheared(const Vec3f& p) { return {p.x + 0.3f * p.y, p.y, p.z}; }
Vec3f stretched_at_constant_volume(const Vec3f& p) { return {1.25f * p.x, 0.8f * p.y, p.z}; }
Vec3f bent(const Vec3f& p) { return {p.x, p.y + 1.5f * p.x * p.x, p.z}; }

TEST(ShapeMatching, ModesKeepTheDeformationsThatTheyHave) {
  using Mode = Cluster::Mode;
  for (const auto place : {&sheared, &stretched_at_constant_volume}) {
    EXPECT_GT(restores({.mode = Mode::rigid}, place), 0.01);
    EXPECT_LT(restores({.mode = Mode::linear, .share = 1}, place), 1e-5);
    EXPECT_GT(restores({.mode = Mode::linear, .share = 0.5f}, place), 0.01);
    EXPECT_LT(restores({.mode = Mode::quadratic, .share = 1}, place), 1e-4);
  }
  EXPECT_GT(restores({.mode = Mode::linear, .share = 1}, &bent), 0.005);
  EXPECT_LT(restores({.mode = Mode::quadratic, .share = 1}, &bent), 1e-4);
}

Vec3f swollen(const Vec3f& p) { return 1.2f * p; }

TEST(ShapeMatching, LinearClustersKeepTheirVolume) {
  Scene scene = free_scene(lattice(4, 0.1f), {.mode = Cluster::Mode::linear, .share = 1});
  const std::vector<Vec3f> rest = scene.objects[0].positions;
  for (Vec3f& p : scene.objects[0].positions) p = swollen(p);
  scene.objects[0].damping = 5;
  World world(scene);
  run(world, 120);
  EXPECT_LT(misshape(world.object(world.objects()[0]).positions(), rest), 0.01);
}

/// The shape error after two seconds, damped, from the given start.
double recovers(const std::vector<Vec3f>& start, Cluster::Mode mode) {
  Scene scene = free_scene(lattice(3, 0.1f), {.mode = mode, .share = 0.5f});
  const std::vector<Vec3f> rest = scene.objects[0].positions;
  scene.objects[0].positions = start;
  scene.objects[0].damping = 10;
  World world(scene);
  run(world, 120);
  return misshape(world.object(world.objects()[0]).positions(), rest);
}

TEST(ShapeMatching, RecoversFromAnyStart) {
  const std::vector<Vec3f> rest = lattice(3, 0.1f).positions;
  std::vector<Vec3f> mirrored = rest, flat = rest, point(rest.size(), Vec3f{1, 2, 3}), random;
  for (Vec3f& p : mirrored) p.x = -2 * p.x;
  for (Vec3f& p : flat) p.y = 0;
  std::mt19937 numbers(3);
  std::uniform_real_distribution<float> in_box(-0.3f, 0.3f);
  for (std::size_t i = 0; i < rest.size(); ++i) random.push_back({in_box(numbers), in_box(numbers), in_box(numbers)});
  for (const Cluster::Mode mode : {Cluster::Mode::rigid, Cluster::Mode::linear, Cluster::Mode::quadratic})
    for (const auto& start : {mirrored, flat, point, random}) EXPECT_LT(recovers(start, mode), 0.01) << int(mode);
}

/// A bar of overlapping clusters that is pinned at one end.
Scene bar() {
  Object object;
  object.name = "bar";
  for (int x = 0; x < 24; ++x)
    for (int y = 0; y < 5; ++y)
      for (int z = 0; z < 5; ++z) object.positions.push_back(0.05f * Vec3f{float(x), float(y), float(z)});
  object.masses.assign(object.positions.size(), 0.01f);
  add_clusters(object, 0.2f, {.mode = Cluster::Mode::linear, .stiffness = Stiffness::compliance(1e-6f)});
  for (int i = 0; i < 25; ++i) object.pins.push_back({i, {}});
  Scene scene;
  scene.add(std::move(object));
  return scene;
}

TEST(ShapeMatching, AnyNumberOfThreadsAndARestoredStateGiveTheSameBits) {
  Scene scene = bar();
  std::vector<std::string> hashes;
  for (const int threads : {1, 2, 4}) {
    scene.settings.threads = threads;
    World world(scene);
    run(world, 20);
    hashes.push_back(world.state_hash());
  }
  World first(scene), second(scene);
  run(first, 9);
  second.restore(first.state());
  run(second, 11);
  hashes.push_back(second.state_hash());
  for (const std::string& hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

TEST(ShapeMatching, ABarOfClustersBendsAndHolds) {
  Scene scene = bar();
  scene.objects[0].damping = 4;
  const std::vector<Vec3f> rest = scene.objects[0].positions;
  World world(scene);
  run(world, 240);
  const std::vector<Vec3f> now = world.object(world.objects()[0]).positions();
  for (int i = 0; i < 25; ++i) EXPECT_EQ(length(now[std::size_t(i)] - rest[std::size_t(i)]), 0);
  const float tip = rest.back().y - now.back().y;
  EXPECT_GT(tip, 0.002f);
  EXPECT_LT(misshape(now, rest), 0.1);
}

TEST(ShapeMatching, GrainsOfARigidClusterLieAsOneStone) {
  const float radius = 0.02f;
  Object stone = make_grains(fill_box({0, 0.1f, 0}, {0.16f, 0.26f, 0.16f}, 2 * radius), {.grains = {.radius = radius}});
  const std::vector<Vec3f> rest = stone.positions;
  add_cluster(stone, all_of(stone));
  Scene scene;
  scene.add(stone);
  scene.add(Collider{.name = "floor", .shape = Plane{}});
  World world(scene);
  run(world, 120);
  const std::vector<Vec3f> now = world.object(world.objects()[0]).positions();
  EXPECT_LT(misshape(now, rest), 0.01);
  for (const Vec3f& p : now) EXPECT_GT(p.y, 0.9f * radius);
  EXPECT_NEAR(now[0].y, radius, 0.1f * radius);
}

template <class Body>
std::string message_of(const Body& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ShapeMatching, ErrorsNameTheClusterAndTheParticle) {
  Object block = lattice(3, 0.1f);
  EXPECT_NE(message_of([&] { add_cluster(block, {0, 27}); }).find("particle 27"), std::string::npos);
  EXPECT_NE(message_of([&] { add_cluster(block, {3, 3}); }).find("particle 3 twice"), std::string::npos);
  EXPECT_NE(message_of([&] { add_cluster(block, {3}); }).find("fewer than two"), std::string::npos);
  EXPECT_NE(message_of([&] { add_clusters(block, 0.01f); }).find("in no cluster"), std::string::npos);
  Scene scene;
  block.clusters.resize(1);
  block.clusters[0].particles = {0, 1, 99};
  scene.add(block);
  EXPECT_NE(message_of([&] { World world(scene); }).find("cluster 0"), std::string::npos);
}

TEST(ShapeMatching, CopiesOfACutJoinTheClusters) {
  Object cloth = make_cloth(grid_mesh(5, 5, 1, 1));
  add_cluster(cloth, all_of(cloth));
  const std::vector<int> path{10, 11, 12, 13, 14};
  const Edit edit = cut(cloth, path);
  EXPECT_GT(edit.object.positions.size(), cloth.positions.size());
  EXPECT_EQ(edit.object.clusters[0].particles.size(), edit.object.positions.size());
}

}  // namespace
}  // namespace pliant
