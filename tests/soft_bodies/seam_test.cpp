// Rigid stitches under load: they close, name what stays open, and keep momentum.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "math/vector.h"
#include "pliant/material.h"
#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "pliant/stitch.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr float ball_radius = 0.12f;  ///< radius [m]
constexpr int panel_columns = 13, panel_rows = 17;

/// Two upright panels, 0.3 m apart, of a width that is 8 % too narrow to go round a ball together.
Object narrow_panels(const Fabric& material, float height = 0.44f) {
  const float half_girth = 3.14159265f * ball_radius * 0.92f;
  const TriangleMesh flat = grid_mesh(panel_columns, panel_rows, half_girth, height);
  TriangleMesh mesh;
  for (const float z : {-0.15f, 0.15f}) {
    const int first = static_cast<int>(mesh.positions.size());
    for (const Vec3f& p : flat.positions) mesh.positions.push_back({p.x, p.z, z});
    for (const auto& [a, b, c] : flat.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  }
  ClothOptions options;
  options.material = material;
  Object object = make_cloth(mesh, options);
  object.name = "cover";
  object.thickness = 0.001f;
  object.damping = 2;
  return object;
}

/// The pairs of both sides: column 0 and the last one of both panels.
std::vector<std::array<int, 2>> sides_of(bool both = true) {
  std::vector<std::array<int, 2>> pairs;
  for (int row = 0; row < panel_rows; ++row)
    for (const int column : {0, panel_columns - 1})
      if (both || column == 0)
        pairs.push_back({row * panel_columns + column, (panel_rows + row) * panel_columns + column});
  return pairs;
}

Scene round_balls(const Fabric& material) {
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  Object cover = narrow_panels(material);
  add_stitches(cover, sides_of(), {.closing_time = 0.5f});
  scene.add(std::move(cover));
  for (const float y : {-ball_radius, ball_radius})
    scene.add(Collider{.name = y < 0 ? "low" : "high", .shape = Sphere{ball_radius}, .position = {0, y, 0}});
  return scene;
}

double distance(const std::vector<Vec3f>& x, const std::array<int, 2>& pair) {
  return static_cast<double>(length(x[static_cast<std::size_t>(pair[0])] - x[static_cast<std::size_t>(pair[1])]));
}

double widest(const World& world, const std::vector<std::array<int, 2>>& pairs) {
  const std::vector<Vec3f> x = world.object(0).positions();
  double gap = 0;
  for (const auto& pair : pairs) gap = std::max(gap, distance(x, pair));
  return gap;
}

TEST(Seam, ClosesRoundBallsThatAreTooThick) {
  Fabric stiff = fabric("cotton");
  stiff.name = "50 kN/m";
  stiff.stretch_stiffness = 50000;
  for (const Fabric& material : {fabric("rubber sheet"), fabric("cotton"), stiff}) {
    World world(round_balls(material));
    double gap = 0;
    for (int frame = 0; frame < 50; ++frame) {
      const Report report = world.step(1.f / 60);
      if (frame < 40) continue;
      gap = std::max(gap, widest(world, sides_of()));
      EXPECT_TRUE(report.warnings.empty()) << report.explain();
    }
    EXPECT_LT(gap, 1e-3) << material.name;
  }
}

/// Both ends of a thread are pinned.
TEST(Seam, NamesWhatCannotBeReached) {
  Object cover = narrow_panels(fabric("cotton"));
  const std::vector<std::array<int, 2>> pairs = sides_of();
  cover.pins = {{pairs[0][0]}, {pairs[0][1]}};
  const double apart = distance(cover.positions, pairs[0]);
  add_stitches(cover, {pairs.data(), 1}, {.closing_time = 0.25f});
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  scene.add(std::move(cover));
  World world(scene);
  Report report;
  for (int frame = 0; frame < 20; ++frame) {
    report = world.step(1.f / 60);
    if (frame < 14) {
      EXPECT_TRUE(report.warnings.empty()) << "the thread is still shortening";
    }
  }
  EXPECT_NEAR(apart, 0.3, 1e-6);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("object 'cover': the stitch of particles 0 and 221 is open by 300 mm"),
            std::string::npos)
      << report.warnings[0];
}

/// Panels that hold by one seam and are torn apart at 6 m/s: nothing acts from outside.
TEST(Seam, KeepsMomentum) {
  Object cover = narrow_panels(fabric("cotton"));
  cover.damping = 0;
  for (Vec3f& p : cover.positions) p.z *= 0.01f;
  cover.velocities.assign(cover.positions.size(), {});
  const std::size_t half = cover.positions.size() / 2;
  for (std::size_t i = 0; i < cover.positions.size(); ++i)
    cover.velocities[i] = {i < half ? 3.f : -3.f, 1, i < half ? -1.f : 1.f};
  add_stitches(cover, sides_of(false), {.closing_time = 0});
  const std::vector<float> masses = cover.masses;
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  scene.add(std::move(cover));
  World world(scene);
  Vec3d before{};
  double total = 0;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    before += convert<double>(world.object(0).velocities()[i]) * static_cast<double>(masses[i]);
    total += static_cast<double>(masses[i]);
  }
  for (int frame = 0; frame < 30; ++frame) {
    EXPECT_TRUE(world.step(1.f / 60).ok());
    if (frame > 2) {
      EXPECT_LT(widest(world, sides_of(false)), 1e-3) << frame;
    }
  }
  Vec3d after{};
  for (std::size_t i = 0; i < masses.size(); ++i)
    after += convert<double>(world.object(0).velocities()[i]) * static_cast<double>(masses[i]);
  EXPECT_LT(length(after - before), 1e-5 * total);
}

TEST(Seam, HasTheSameBitsOnAnyThreads) {
  std::vector<std::string> hashes;
  for (const int threads : {1, 3}) {
    Scene scene = round_balls(fabric("cotton"));
    scene.settings.threads = threads;
    World world(scene);
    for (int frame = 0; frame < 34; ++frame) world.step(1.f / 60);
    hashes.push_back(world.state_hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace pliant
