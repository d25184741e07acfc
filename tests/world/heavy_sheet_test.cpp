// Tests that no frame of a heavy sheet on a light one is without a bound: what costs time is counted. The Report says
// that such frames are slow.
#include <gtest/gtest.h>

#include <string>

#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;

Object loose_sheet(const std::string& name, float height, float area_density) {
  ClothOptions options;
  options.name = name;
  options.material = fabric("cotton");
  options.material.area_density = area_density;
  Object object = make_cloth(sheet(10, 1, height), options);
  object.self_collision = object.collides = true;
  return object;
}

/// The case of a report, smaller: a sheet of 1 kg/m^2 times `ratio` / 1000 falls on a light one over a ball.
Scene heavy_on_light(float ratio, int most_substeps) {
  Scene scene;
  scene.settings.threads = 1;
  scene.settings.most_substeps = most_substeps;
  scene.add(loose_sheet("light", 0.65f, 1e-3f));
  scene.add(loose_sheet("heavy", 0.7f, 1e-3f * ratio));
  for (Vec3f& p : scene.objects[1].positions) p += {0.02f, 0, 0.01f};
  MeshCollider ball;
  ball.mesh = sphere_mesh(2);
  for (Vec3f& p : ball.mesh.positions) p = p * 0.3f + Vec3f{0, 0.3f, 0};
  scene.add(ball);
  return scene;
}

constexpr const char* heavy_words = "are 1e+06 times those of 'light', on which it can press";

TEST(HeavySheet, TakesNoFrameWithoutABound) {
  constexpr int most_by_state = 100;  // by default, where substeps follow the State
  for (const int most : {0, 20}) {
    const Scene scene = heavy_on_light(1e6f, most);
    const int bound = most > 0 ? most : most_by_state;
    World world(scene);
    const auto vertices = static_cast<std::int64_t>(200 + scene.mesh_colliders[0].mesh.positions.size());
    std::int64_t truncated = 0;
    for (int frame = 0; frame < 25; ++frame) {
      const Report report = world.step(dt);
      ASSERT_TRUE(report.ok()) << report.explain();
      EXPECT_LE(report.substeps, bound) << frame;
      EXPECT_LE(report.pairs.rebuilds, report.substeps) << frame;
      EXPECT_LE(report.pairs.truncated, vertices * report.substeps) << frame;
      EXPECT_LE(report.pairs.candidates, 100 * vertices) << frame;
      truncated += report.pairs.truncated;
    }
    EXPECT_GT(truncated, 1000) << "the filter has no work, so this shows nothing";
  }
}

TEST(HeavySheet, IsNamedByTheFirstReport) {
  for (const float ratio : {1e3f, 1e6f}) {
    World world(heavy_on_light(ratio, 0));
    const std::string said = world.step(dt).explain();
    EXPECT_EQ(said.find(heavy_words) != std::string::npos, ratio > 1e4f) << said;
    EXPECT_EQ(said.find("`most_substeps` bounds what frames take") != std::string::npos, ratio > 1e4f) << said;
    EXPECT_EQ(world.step(dt).explain().find(heavy_words), std::string::npos) << "only once";
  }
}

}  // namespace
}  // namespace pliant
