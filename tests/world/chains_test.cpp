// Tests whole runs with chains and tethers: the same hash on any threads and kernels, ropes that hold, cloth that
// hardly stretches.
#include <gtest/gtest.h>

#include <cmath>

#include "pliant/world.h"
#include "support/kernels.h"

namespace pliant {
namespace {

using testing_support::available_isas;

Scene hanging(int n, int substeps, int iterations, Stiffness stretch) {
  Scene scene;
  ClothOptions options;
  options.material = fabric("cotton");
  options.stretch = stretch;
  const int cloth = scene.add_cloth(grid_mesh(n, n, 1, 1), options);
  scene.pin(cloth, {0}, {});
  scene.pin(cloth, {n - 1}, Motion{{Keyframe{0, {}, {}}, Keyframe{1, {-0.2f, 0.1f, 0}, {}}}, {}, false});
  scene.settings.substeps = substeps;
  scene.settings.iterations = iterations;
  scene.settings.sweep = Sweep::chains;
  scene.settings.sweep_options.tethers = true;
  Collider ball;
  ball.shape = Sphere{0.2f};
  ball.position = {0, -0.4f, 0};
  scene.add(ball);
  return scene;
}

std::string hash_after_run(const Scene& scene, const Settings& settings, int frames) {
  World world(scene, settings);
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(1.f / 60);
    EXPECT_TRUE(report.ok()) << report.explain();
  }
  return world.state_hash();
}

/// A rope of 40 links that swings down from the horizontal, held at one end by a pin or by an attachment.
Scene held_rope(bool is_pinned) {
  std::vector<Vec3f> points;
  for (int i = 0; i <= 40; ++i) points.push_back({0.05f * static_cast<float>(i), 0, 0});
  Scene scene;
  const int rope = scene.add(make_rope(points));
  if (is_pinned)
    scene.pin(rope, {0});
  else
    scene.objects[0].attachments.push_back({0, points[0], {}, Stiffness::rigid()});
  scene.settings.sweep = Sweep::chains;
  return scene;
}

TEST(ChainSweep, holds_by_a_rigid_attachment_as_by_a_pin) {
  World pinned(held_rope(true)), attached(held_rope(false));
  for (int frame = 0; frame < 40; ++frame) {
    ASSERT_TRUE(pinned.step(1.f / 60).ok());
    ASSERT_TRUE(attached.step(1.f / 60).ok());
  }
  const std::vector<Vec3f> by_pin = pinned.object(0).positions(), by_attachment = attached.object(0).positions();
  ASSERT_LT(by_pin[40].y, -0.5f) << "it has swung";
  for (std::size_t i = 0; i < by_pin.size(); ++i) EXPECT_LT(length(by_pin[i] - by_attachment[i]), 1e-5f) << i;
}

TEST(ChainSweep, gives_one_hash_whatever_runs_it) {
  for (int iterations : {1, 2}) {
    Scene scene = hanging(70, 4, iterations, Stiffness::compliance(iterations == 1 ? 0.f : 1e-6f));
    std::vector<Vec3f> points;
    for (int i = 0; i <= 33; ++i) points.push_back({2 + 0.05f * static_cast<float>(i), 0, 0});
    const int rope = scene.add(make_rope(points));
    scene.pin(rope, {0, 33});
    Settings settings = scene.settings;
    settings.isa = "sequential";
    settings.threads = 1;
    const std::string expected = hash_after_run(scene, settings, 6);
    settings.isa.clear();
    for (int threads : {1, 2, 3, 8}) {
      settings.threads = threads;
      EXPECT_EQ(hash_after_run(scene, settings, 6), expected) << threads << " threads";
    }
    for (const std::string& isa : available_isas()) {
      settings.isa = isa;
      EXPECT_EQ(hash_after_run(scene, settings, 6), expected) << isa;
    }
    settings.isa.clear();
    settings.record_multipliers = settings.measure = true;
    EXPECT_EQ(hash_after_run(scene, settings, 6), expected) << "looking changes nothing";
  }
}

TEST(ChainSweep, holds_a_rope_in_one_iteration) {
  std::vector<Vec3f> points;
  for (int i = 0; i <= 100; ++i) points.push_back({0.01f * static_cast<float>(i), 0, 0});
  Scene scene;
  const int rope = scene.add(make_rope(points));
  scene.pin(rope, {0});
  scene.settings.substeps = 20;
  scene.settings.sweep = Sweep::chains;
  for (const float softness : {0.f, 0.1f}) {
    scene.settings.sweep_options.chain_softness = softness;
    World world(scene);
    for (int frame = 0; frame < 90; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
    EXPECT_LT(world.measure().stretch().largest, 1.0005);
    EXPECT_GT(world.measure().stretch().mean, 0.9995);
  }
}

TEST(ChainSweep, bears_a_straight_row_between_two_pins) {
  std::vector<Vec3f> points;
  for (int i = 0; i <= 64; ++i) points.push_back({static_cast<float>(i) / 64, 0, 0});
  Scene scene;
  const int rope = scene.add(make_rope(points));
  scene.pin(rope, {0, 64});
  scene.settings.substeps = 10;
  scene.settings.sweep = Sweep::chains;
  World world(scene);
  double largest = 0;
  for (int frame = 0; frame < 120; ++frame) {
    ASSERT_TRUE(world.step(1.f / 60).ok());
    largest = std::max(largest, world.measure().stretch().largest);
  }
  EXPECT_LT(largest, 1.07) << "the row swings; without the limit a link is 9.8 % too long at its first turn";
  EXPECT_LT(world.measure().stretch().mean, 1.005);
  for (const Vec3f& p : world.object(rope).positions()) EXPECT_LT(std::fabs(p.y), 0.1f);
}

TEST(ChainSweep, keeps_cloth_from_stretching_at_few_substeps) {
  Scene scene = hanging(40, 5, 1, Stiffness::rigid());
  scene.colliders.clear();
  scene.objects[0].pins[1].motion = {};
  World world(scene);
  double largest = 0;
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_TRUE(world.step(1.f / 60).ok());
    largest = std::max(largest, world.measure().stretch().largest);
  }
  EXPECT_LT(largest, 1.1);
  Settings plain = scene.settings;
  plain.sweep = Sweep::tiled;
  plain.sweep_options.tethers = false;
  World other(scene, plain);
  double others = 0;
  for (int frame = 0; frame < 60; ++frame) {
    other.step(1.f / 60);
    others = std::max(others, other.measure().stretch().largest);
  }
  EXPECT_GT(others, 1.5) << "or this test shows nothing";
}

TEST(Tethers, reach_from_where_their_pins_are_now) {
  std::vector<Vec3f> points;
  for (int i = 0; i <= 30; ++i) points.push_back({0, -0.05f * static_cast<float>(i), 0});
  Scene scene;
  const int rope = scene.add(make_rope(points));
  scene.pin(rope, {0}, Motion{{Keyframe{0, {}, {}}, Keyframe{1, {0, 6, 0}, {}}}, {}, false});
  scene.settings.substeps = 1;
  scene.settings.sweep_options.tethers = true;
  World world(scene);
  for (int frame = 0; frame < 20; ++frame) {
    world.step(1.f / 60);
    const std::vector<Vec3f> x = world.object(rope).positions();
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_LT(std::sqrt(length_squared(x[i] - x[0])), 0.05 * static_cast<double>(i) + 1e-5) << "frame " << frame;
  }
}

TEST(ChainSweep, gives_multipliers_and_counts_as_any_other) {
  Scene scene;
  std::vector<Vec3f> points;
  for (int i = 0; i <= 10; ++i) points.push_back({0, -0.1f * static_cast<float>(i), 0});
  RopeOptions options;
  options.linear_density = 10;
  const int rope = scene.add(make_rope(points, options));
  scene.pin(rope, {0});
  scene.settings.sweep = Sweep::chains;
  scene.settings.sweep_options.chain_softness = 0;
  scene.settings.record_multipliers = true;
  scene.settings.substeps = 20;
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) world.step(1.f / 60);
  const float h = 1.f / 60 / 20;
  const std::vector<float> multipliers = world.object(rope).multipliers("distance");
  ASSERT_EQ(multipliers.size(), 10u);
  for (int k = 0; k < 10; ++k)  // each link carries the weight of all links below it
    EXPECT_NEAR(-multipliers[k] / (h * h), 9.81f * (9.5f - static_cast<float>(k)), 0.05f);
  EXPECT_EQ(world.object(rope).info().constraints[0].second, 10);
}

}  // namespace
}  // namespace pliant
