// A scene has one hash, whatever runs it: threads, lanes, the sequential reference, a second World. These scenes are
// made in code and large enough for several tiles; tests/golden compares those in files with recorded hashes.
#include <gtest/gtest.h>

#include "support/scenes.h"
#include "support/ways_to_run.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Cloth of more than one tile that falls over a ball and a floor, in wind.
Scene large_cloth() {
  Scene scene;
  ClothOptions options;
  options.material = fabric("cotton");
  const int cloth = scene.add_cloth(grid_mesh(90, 70, 1.8f, 1.4f), options);
  scene.pin(cloth, {0}, straight({0.2f, 0, 0.1f}, 0.5f));
  scene.wind = {{2, 0, 1}, 0.5f, 0.2f, 1.2f};
  Collider ball, floor;
  ball.shape = Sphere{0.25f};
  ball.position = {0.1f, -0.26f, 0};
  floor.position = {0, -0.5f, 0};
  scene.add(ball);
  scene.add(floor);
  return scene;
}

/// Objects of every kind with every law of stiffness, and more than one iteration.
Scene mixture() {
  Scene scene;
  ClothOptions isometric, balloon;
  isometric.bending_model = ClothOptions::Bending::isometric;
  isometric.stretch = Stiffness::pbd(0.95f);
  scene.add_cloth(grid_mesh(20, 20, 0.5f, 0.5f), isometric);
  balloon.volume = Volume{1.3f, Stiffness::compliance(1e-8f, 1e-4f)};
  balloon.velocity = {0, 1, 0};
  TriangleMesh sphere = sphere_mesh(3);
  for (Vec3f& p : sphere.positions) p = p * 0.2f + Vec3f{0, 0.5f, 0};
  scene.add_cloth(sphere, balloon);
  RopeOptions rope;
  rope.bends = true;
  std::vector<Vec3f> points;
  for (int i = 0; i < 40; ++i) points.push_back({-0.5f, 0.3f, 0.03f * static_cast<float>(i)});
  Object line = make_rope(points, rope);
  line.attachments.push_back({0, {-0.5f, 0.5f, 0}, straight({0, 0.2f, 0}, 0.3f), Stiffness::compliance(1e-4f, 0.1f)});
  line.damping = 0.5f;
  scene.add(line);
  Collider box, capsule;
  box.shape = Box{{1, 0.05f, 1}};
  box.position = {0, -0.2f, 0};
  box.motion = {{Keyframe{0, {}, {}}, Keyframe{0.3f, {0, 0.05f, 0}, rotation({0, 0, 1}, 5)}}, {}, true};
  box.restitution = 0.4f;
  capsule.shape = Capsule{0.05f, 0.2f};
  capsule.position = {0.1f, -0.05f, 0.1f};
  scene.add(box);
  scene.add(capsule);
  scene.forces.push_back([](const Vec3f& x, const Vec3f& v, float mass, float) {
    return Vec3f{-0.1f * v.x * mass, 0.01f * x.z, 0};
  });
  return scene;
}

struct Named {
  const char* name;
  Scene (*make)();
  int substeps, iterations;
};

class Determinism : public testing::TestWithParam<Named> {
 protected:
  std::string run(const Settings& settings) {
    World world(scene_, settings);
    for (int frame = 0; frame < 12; ++frame) {
      const Report report = world.step(dt);
      EXPECT_TRUE(report.ok()) << report.explain();
    }
    return world.state_hash();
  }
  Scene scene_ = GetParam().make();
  Settings settings_ = settings_of(GetParam().substeps, GetParam().iterations);
};
INSTANTIATE_TEST_SUITE_P(Scenes, Determinism,
                         testing::Values(Named{"large_cloth", large_cloth, 5, 1},
                                         Named{"large_cloth_iterated", large_cloth, 2, 3},
                                         Named{"mixture", mixture, 5, 1}, Named{"mixture_iterated", mixture, 2, 4}),
                         [](const auto& named) { return std::string(named.param.name); });

TEST_P(Determinism, OneHashWhateverRunsIt) {
  Settings settings = settings_;
  settings.sweep = Sweep::sequential;
  const std::string expected = run(settings);
  settings.sweep = Sweep::tiled;
  const auto hash = [&](int threads, const std::string& isa) {
    settings.threads = threads;
    settings.isa = isa;
    return run(settings);
  };
  expect_hash(expected, hash, ways_to_run());
  settings.isa.clear();
  settings.record_multipliers = settings.measure = true;
  EXPECT_EQ(run(settings), expected) << "looking changes nothing";
}

}  // namespace
}  // namespace pliant
