// Simulates meshes from elsewhere: each becomes cloth, and a balloon if it is closed, and falls on a ball and the
// ground for a moment. The test checks that it stays finite and in its place; whether it looks right is for
// scripts/try_meshes and the eye. Without the data folder there is nothing to test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/scene.h"
#include "pliant/world.h"
#include "support/paths.h"

namespace pliant {
namespace {

constexpr float thickness = 0.005f;
constexpr int frames = 12;
constexpr float speed = 4;  ///< of the fall [m/s]

std::vector<std::string> mesh_paths() {
  std::vector<std::string> paths;
  for (const char* folder : {"cloth", "surface"}) {
    const std::filesystem::path root = test::in_shared_data(folder);
    if (!std::filesystem::is_directory(root)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
      const std::string suffix = entry.path().extension().string();
      if (suffix == ".obj" || suffix == ".ply" || suffix == ".stl") paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// Scales a mesh to one metre and puts its lowest point just above the ball.
TriangleMesh placed(TriangleMesh mesh) {
  Vec3f low = mesh.positions.front(), high = low;
  for (const Vec3f& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3f size = high - low;
  const float scale = 1 / std::max({size.x, size.y, size.z});
  const Vec3f foot{(low.x + high.x) / 2, low.y, (low.z + high.z) / 2};
  for (Vec3f& p : mesh.positions) p = (p - foot) * scale + Vec3f{0, 0.62f, 0};
  return mesh;
}

Scene falling(const TriangleMesh& mesh, bool balloon) {
  Scene scene;
  ClothOptions options;
  options.material = fabric("cotton");
  options.material.thickness = thickness;
  options.velocity = {0, -speed, 0};
  if (balloon) options.volume = Volume{1.1f, {}};
  scene.add_cloth(mesh, options);
  Collider ground, ball;
  ball.name = "ball";
  ball.shape = Sphere{0.3f};
  ball.position = {0, 0.3f, 0};
  scene.add(ground);
  scene.add(ball);
  return scene;
}

float highest(const std::vector<Vec3f>& positions) {
  const auto lower = [](const Vec3f& a, const Vec3f& b) { return a.y < b.y; };
  return std::max_element(positions.begin(), positions.end(), lower)->y;
}

/// A balloon bounces, but no faster than it came.
void expect_sensible(const Scene& scene) {
  World world(scene);
  const float ceiling = highest(scene.objects.front().positions) + speed * scene.frame_time * frames;
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(scene.frame_time);
    ASSERT_TRUE(report.ok()) << report.explain();
  }
  for (const Vec3f& p : world.object(0).positions()) {
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    ASSERT_LT(std::max(std::fabs(p.x), std::fabs(p.z)), 2);
    ASSERT_GT(p.y, thickness / 3);  // 0.36 of it at one point of a building
    ASSERT_LT(p.y, ceiling);
  }
  if (!scene.objects.front().volume) return;
  const double rest = World(scene).object(0).enclosed_volume();
  EXPECT_NEAR(world.object(0).enclosed_volume() / rest, 1.1, 0.05);
}

bool is_closed(const TriangleMesh& mesh) {
  const std::vector<Finding> findings = inspect(mesh);
  return std::none_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.message.rfind("open, with", 0) == 0 ||
           finding.message.find("more than two triangles") != std::string::npos;
  });
}

class Meshes : public testing::TestWithParam<std::string> {};

TEST_P(Meshes, FallAsCloth) { expect_sensible(falling(placed(read_mesh(GetParam())), false)); }

TEST_P(Meshes, FallAsBalloonsWhereClosed) {
  const TriangleMesh mesh = placed(read_mesh(GetParam()));
  if (is_closed(mesh)) {
    expect_sensible(falling(mesh, true));
  } else {
    EXPECT_THROW(falling(mesh, true), Error);
  }
}

std::string name_of(const testing::TestParamInfo<std::string>& info) {
  std::string name = std::filesystem::path(info.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name + "_" + std::to_string(info.index);
}

INSTANTIATE_TEST_SUITE_P(FromElsewhere, Meshes, testing::ValuesIn(mesh_paths()), name_of);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Meshes);

}  // namespace
}  // namespace pliant
