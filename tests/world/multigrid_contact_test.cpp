// Tests the multigrid sweep with contact between surfaces: folded and layered cloth stretches as little as single
// cloth, and momentum is conserved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/vector.h"
#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float layer_thickness = 0.004f;

TriangleMesh sheet_mesh_at(int n, float size, const Vec3f& at) {
  TriangleMesh mesh = sheet(n, size, at.y);
  for (Vec3f& p : mesh.positions) p += Vec3f{at.x, 0, at.z};
  return mesh;
}

/// Three sheets: the upper two lie on the lowest, which hangs by its corners.
Scene hammock() {
  Scene scene;
  for (int i = 0; i < 3; ++i)
    scene.add(cloth(sheet_mesh_at(i == 0 ? 24 : 16, i == 0 ? 0.5f : 0.3f,
                                  {0.003f * static_cast<float>(i), 0.012f * static_cast<float>(i), 0}),
                    layer_thickness));
  scene.pin(0, {0, 23, 24 * 23, 24 * 24 - 1});
  return scene;
}

double worst_p99(Scene scene, Sweep sweep, int substeps) {
  scene.settings = settings_of(substeps);
  scene.settings.sweep = sweep;
  World world(scene);
  double worst = 0;
  for (int frame = 0; frame < 60; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    worst = std::max(worst, world.measure().stretch().p99);
  }
  return worst;
}

TEST(MultigridContact, LayersStretchAsLittleAsOneSheet) {
  EXPECT_LT(worst_p99(hammock(), Sweep::multigrid, 10), 1.03);
  EXPECT_GT(worst_p99(hammock(), Sweep::tiled, 20), 1.05);
}

/// Two sheets of different mass meet head-on in free flight. Contacts must push both equally, whatever the correction
/// does.
TEST(MultigridContact, KeepsMomentum) {
  Scene scene;
  scene.gravity = {};
  scene.add(cloth(sheet_mesh_at(20, 0.4f, {}), layer_thickness));
  scene.add(cloth(sheet_mesh_at(14, 0.2f, {0.01f, 0.02f, 0.02f}), layer_thickness));
  for (float& mass : scene.objects[1].masses) mass *= 3;
  scene.objects[1].velocities.assign(scene.objects[1].positions.size(), {0.3f, -2, 0});
  scene.settings = settings_of(6);
  scene.settings.sweep = Sweep::multigrid;
  World world(scene);
  const auto momentum = [&] {
    Vec3<double> sum{};
    for (std::size_t i = 0; i < world.state().positions.size(); ++i) {
      const Record& v = world.state().velocities[i];
      sum += Vec3<double>{double(v.x), double(v.y), double(v.z)} * (1 / double(world.state().positions[i].w));
    }
    return sum;
  };
  const Vec3<double> before = momentum();
  std::int64_t contacts = 0;
  for (int frame = 0; frame < 20; ++frame) contacts = std::max(contacts, world.step(dt).pairs.contacts);
  EXPECT_GT(contacts, 20);
  EXPECT_LT(length(momentum() - before), 2e-4 * length(before));
}

}  // namespace
}  // namespace pliant
