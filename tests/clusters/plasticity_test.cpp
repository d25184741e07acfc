// Clusters whose rest shapes flow: what is beyond the yield strain stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pliant/cluster.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/grains.h"
#include "pliant/liquid.h"
#include "pliant/world.h"
#include "support/run.h"

namespace pliant {
namespace {

/// A block of 4 x 4 x 4 particles of 1 g, 0.1 m apart, as one cluster.
Scene block(const Plasticity& plasticity, Cluster::Mode mode = Cluster::Mode::rigid) {
  Object object;
  object.name = "block";
  std::vector<int> all;
  for (int i = 0; i < 64; ++i) {
    object.positions.push_back(0.1f * Vec3f{float(i % 4) - 1.5f, float(i / 4 % 4) - 1.5f, float(i / 16) - 1.5f});
    all.push_back(i);
  }
  object.masses.assign(64, 0.001f);
  add_cluster(object, all,
              {.mode = mode, .share = 0.5f, .stiffness = Stiffness::compliance(1e-5f, 600), .plasticity = plasticity});
  Scene scene;
  scene.gravity = {};
  scene.settings.substeps = 20;
  scene.settings.threads = 1;
  scene.add(std::move(object));
  return scene;
}

using testing_support::run;

std::vector<Vec3f> stretched(const Object& object, float by) {
  std::vector<Vec3f> out;
  for (const Vec3f& x : object.positions) out.push_back({x.x * by, x.y / std::sqrt(by), x.z / std::sqrt(by)});
  return out;
}

/// The Edit that fixes all particles of a block.
Edit held(const Scene& scene) {
  Edit edit = unchanged(scene.objects[0]);
  edit.object.masses.assign(64, INFINITY);
  return edit;
}

/// The logarithmic strain that a block has along x after it was held at a stretch, at constant volume, and let go.
double strain_left(const Scene& scene, float stretch, int held_frames) {
  World world(scene);
  world.edit(0, held(scene));
  std::vector<int> all = scene.objects[0].clusters[0].particles;
  world.object(0).set_targets(all, stretched(scene.objects[0], stretch));
  run(world, held_frames);
  world.edit(0, unchanged(scene.objects[0]));
  run(world, 240);
  const std::vector<Vec3f> at = world.object(0).positions();
  double now = 0, before = 0, volume_now = 1;
  for (std::size_t i = 0; i < at.size(); ++i) {
    now += std::abs(static_cast<double>(at[i].x));
    before += std::abs(static_cast<double>(scene.objects[0].positions[i].x));
  }
  const auto extent = [&](auto part) {
    const auto [low, high] =
        std::minmax_element(at.begin(), at.end(), [&](const Vec3f& a, const Vec3f& b) { return part(a) < part(b); });
    return static_cast<double>(part(*high) - part(*low)) / 0.3;
  };
  volume_now = extent([](const Vec3f& v) { return v.x; }) * extent([](const Vec3f& v) { return v.y; }) *
               extent([](const Vec3f& v) { return v.z; });
  EXPECT_NEAR(volume_now, 1, 1e-3);
  return std::log(now / before);
}

TEST(PlasticClusters, SpringBackBelowTheYieldStrain) {
  EXPECT_NEAR(strain_left(block({.yield = 0.3f}), 1.25f, 30), 0, 1e-4);
}

TEST(PlasticClusters, KeepWhatIsBeyondTheYieldStrain) {
  for (const Cluster::Mode mode : {Cluster::Mode::rigid, Cluster::Mode::linear, Cluster::Mode::quadratic})
    for (const float stretch : {0.7f, 1.4f}) {
      const double strain = std::log(static_cast<double>(stretch)),
                   beyond = std::copysign(std::abs(strain) - 0.1, strain);
      EXPECT_NEAR(strain_left(block({.yield = 0.1f}, mode), stretch, 10), beyond, 2e-3) << stretch << ", " << int(mode);
    }
}

TEST(PlasticClusters, CreepAtTheirRate) {
  const double rate = 0.8, ramp = 1.0 / 60;  // half of it counts
  for (const int frames : {30, 90}) {
    const double held = 1 - std::exp(-rate * (frames / 60. - ramp / 2));
    EXPECT_NEAR(strain_left(block({.yield = 0.0f, .rate = 0.8f, .most = 1}), 1.5f, frames) / (std::log(1.5) * held), 1,
                0.03)
        << frames;
  }
}

TEST(PlasticClusters, FlowUpToTheMost) {
  EXPECT_NEAR(strain_left(block({.yield = 0.05f, .most = 0.1f}), 1.5f, 30), 0.1, 1e-3);
}

/// One that spins flies apart a little, and flows; nothing acts from outside.
TEST(PlasticClusters, KeepTheirMomentum) {
  Scene scene = block({.yield = 0, .rate = 50});
  Object& object = scene.objects[0];
  for (const Vec3f& x : object.positions) object.velocities.push_back({-6 * x.y + 1, 6 * x.x, 0});
  const auto spin = [](const World& world) {
    const std::vector<Vec3f> x = world.object(0).positions(), v = world.object(0).velocities();
    double sum = 0, drift = 0;
    for (std::size_t i = 0; i < x.size(); ++i) drift += static_cast<double>(v[i].x) / 64;
    double middle_y = 0, middle_x = 0;
    for (const Vec3f& p : x) {
      middle_x += static_cast<double>(p.x) / 64;
      middle_y += static_cast<double>(p.y) / 64;
    }
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += (static_cast<double>(x[i].x) - middle_x) * static_cast<double>(v[i].y) -
             (static_cast<double>(x[i].y) - middle_y) * (static_cast<double>(v[i].x) - drift);
    EXPECT_NEAR(drift, 1, 1e-5);
    return sum;
  };
  World world(scene);
  const double before = spin(world);
  run(world, 120);
  EXPECT_NEAR(spin(world) / before, 1, 2e-3);
  EXPECT_NE(world.state().flowed[0], 1);
}

/// Two blocks of grains, one on the other.
Scene dented(int threads) {
  Object object = make_grains(fill_box({0, 0, 0}, {0.1f, 0.3f, 0.1f}, 0.02f), {.grains = {.radius = 0.01f}});
  add_clusters(object, 0.06f,
               {.mode = Cluster::Mode::linear,
                .share = 0.5f,
                .stiffness = Stiffness::compliance(1e-4f, 10),
                .plasticity = Plasticity{.yield = 0.01f, .rate = 5}});
  Scene scene;
  scene.add(std::move(object));
  scene.add(Collider{.name = "floor"});
  scene.settings.threads = threads;
  return scene;
}

TEST(PlasticClusters, FollowFromTheState) {
  World one(dented(1)), three(dented(3));
  run(one, 20);
  run(three, 20);
  EXPECT_EQ(hash(one.state()), hash(three.state()));
  const State kept = one.state();
  EXPECT_FALSE(kept.flowed.empty());
  EXPECT_NE(kept.flowed, World(dented(1)).state().flowed);
  run(one, 20);
  World again(dented(1));
  again.restore(kept);
  run(again, 20);
  EXPECT_EQ(hash(again.state()), hash(one.state()));
}

TEST(PlasticClusters, AnEditKeepsWhatHasFlowed) {
  const Scene scene = dented(1);
  World world(scene);
  run(world, 20);
  const std::vector<float> flowed = world.state().flowed;
  Edit edit = unchanged(scene.objects[0]);
  edit.object.damping = 1;
  world.edit(0, edit);
  EXPECT_EQ(world.state().flowed, flowed);
  for (Vec3f& x : edit.object.positions) x.x *= 1.25f;  // another rest shape
  world.edit(0, edit);
  EXPECT_NE(world.state().flowed, flowed);
}

/// A shape without volume has no strain; what a cluster is pressed to must not make its rest shape infinite.
TEST(PlasticClusters, StayFiniteWherePressedFlat) {
  const Scene scene = block({.yield = 0.01f});
  World world(scene);
  world.edit(0, held(scene));
  for (const float height : {0.01f, 1e-6f, 1e-9f, 0.f}) {
    std::vector<Vec3f> flat;
    for (const Vec3f& x : scene.objects[0].positions)
      flat.push_back({0.8f * x.x - 0.6f * x.y * height, 0.6f * x.x + 0.8f * x.y * height, x.z});
    world.object(0).set_targets(scene.objects[0].clusters[0].particles, flat);
    run(world, 3);
    for (const float number : world.state().flowed) EXPECT_LT(std::abs(number), 20) << height;
  }
  world.edit(0, unchanged(scene.objects[0]));
  run(world, 60);
}

TEST(PlasticClusters, AreDividedWithWhatHasFlowed) {
  const Scene scene = block({.yield = 0.05f});
  World world(scene);
  world.edit(0, held(scene));
  world.object(0).set_targets(scene.objects[0].clusters[0].particles, stretched(scene.objects[0], 1.4f));
  run(world, 5);
  const std::vector<float> whole = world.state().flowed;
  ASSERT_EQ(whole.size(), 9u);
  Edit divided = held(scene);
  divided.object.clusters.push_back(divided.object.clusters[0]);
  Cluster &first = divided.object.clusters[1], &second = divided.object.clusters[0];
  first.particles.resize(40);
  second.particles.erase(second.particles.begin(), second.particles.begin() + 24);
  world.edit(0, divided);
  const std::vector<float>& parts = world.state().flowed;
  ASSERT_EQ(parts.size(), 18u);
  EXPECT_TRUE(std::equal(whole.begin(), whole.end(), parts.begin()));
  EXPECT_TRUE(std::equal(whole.begin(), whole.end(), parts.begin() + 9));
}

TEST(PlasticClusters, NameWhatCannotFlow) {
  Scene scene = block({.yield = 0.1f});
  for (Vec3f& x : scene.objects[0].positions) x.z = 0;
  const auto words = [&] {
    std::string all;
    for (const Finding& finding : inspect(scene)) all += finding.message + "\n";
    return all;
  };
  EXPECT_NE(words().find("flat"), std::string::npos) << words();
  World world(scene);  // it stays elastic
  run(world, 2);
  scene = block({.yield = 0.1f});
  scene.objects[0].clusters[0].stiffness = Stiffness::rigid();
  EXPECT_NE(words().find("rigid"), std::string::npos) << words();
  scene = block({.yield = -1});
  EXPECT_NE(words().find("plasticity"), std::string::npos) << words();
}

}  // namespace
}  // namespace pliant
