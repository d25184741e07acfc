// Tests the multigrid sweep in a World: cloth hardly stretches however fine it is, on regular and irregular meshes,
// hung and draped; compliant cloth stretches as it should; sliding cloth slides.
#include <gtest/gtest.h>

#include <random>

#include "pliant/error.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "support/scenes.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A grid whose particles are moved by up to 0.3 of a cell; the diagonal of each cell has a random direction.
TriangleMesh jittered(int n) {
  std::mt19937 random(7);
  const auto uniform = [&] { return static_cast<float>(random() % 65536) / 32768 - 1; };
  TriangleMesh mesh = grid_mesh(n, n, 1, 1);
  const float step = 0.3f / static_cast<float>(n - 1);
  for (int j = 1; j + 1 < n; ++j)
    for (int i = 1; i + 1 < n; ++i)
      mesh.positions[std::size_t(j * n + i)] += Vec3f{step * uniform(), 0, step * uniform()};
  mesh.triangles.clear();
  for (int j = 0; j + 1 < n; ++j) {
    for (int i = 0; i + 1 < n; ++i) {
      const int a = j * n + i, b = a + 1, c = a + n, d = c + 1;
      const bool either = uniform() > 0;
      mesh.triangles.push_back(either ? std::array<int, 3>{a, c, b} : std::array<int, 3>{a, c, d});
      mesh.triangles.push_back(either ? std::array<int, 3>{b, c, d} : std::array<int, 3>{a, d, b});
    }
  }
  return mesh;
}

Object cotton(const TriangleMesh& mesh) {
  ClothOptions options;
  options.material = fabric("cotton");
  options.stretch = Stiffness::rigid();
  return make_cloth(mesh, options);
}

Scene hung_mesh(const TriangleMesh& mesh, int n) {
  Scene scene;
  Object object = cotton(mesh);
  object.pins = {{0, {}}, {n - 1, {}}};
  scene.add(object);
  return scene;
}

/// A sheet without pins over the top of a ball.
Scene draped(const TriangleMesh& mesh) {
  Scene scene;
  Object object = cotton(mesh);
  object.thickness = 0.005f;
  object.static_friction = object.kinetic_friction = 0.3f;
  Collider ball;
  ball.shape = Sphere{0.3f};
  ball.position = {0, mesh.positions[0].y - 0.31f, 0};
  ball.static_friction = ball.kinetic_friction = 0.3f;
  scene.add(ball);
  scene.add(object);
  return scene;
}

/// Cloth that falls on a rough box, corners included.
Scene on_a_box() {
  Scene scene;
  Object sheet = cotton(grid_mesh(40, 40, 1, 1));
  sheet.thickness = 0.005f;
  sheet.static_friction = sheet.kinetic_friction = 0.5f;
  Collider box;
  box.shape = Box{{0.25f, 0.05f, 0.25f}};
  box.position = {0, -0.08f, 0};
  box.static_friction = box.kinetic_friction = 0.5f;
  scene.add(box);
  scene.add(sheet);
  return scene;
}

struct Worst {
  double p99 = 0, largest = 0;
};

Worst worst_of(Scene scene, Sweep sweep, int substeps, int frames = 70) {
  scene.settings.sweep = sweep;
  scene.settings.substeps = substeps;
  scene.settings.threads = 1;
  World world(scene);
  Worst worst;
  for (int frame = 0; frame < frames; ++frame) {
    EXPECT_TRUE(world.step(1.f / 60).ok());
    worst.p99 = std::max(worst.p99, world.measure().stretch().p99);
    worst.largest = std::max(worst.largest, world.measure().stretch().largest);
  }
  return worst;
}

/// The limit of overstretch follows the sweep. Two cycles leave the longest edges at the pins and in folds that run
/// through.
TEST(Multigrid, StretchesNoEdgeBeyondTheLimit) {
  Scene scene = hung_mesh(grid_mesh(40, 40, 1, 1), 40);
  EXPECT_LT(worst_of(scene, Sweep::multigrid, 6).largest, 1.0505);
  scene.settings.sweep_options.most_overstretch = 0;
  EXPECT_GT(worst_of(scene, Sweep::multigrid, 6).largest, 1.06);
}

/// Simulates the first swing, and part of the second.
TEST(Multigrid, StretchesNoMoreTheFinerTheMesh) {
  double plain = 0;
  for (int n : {24, 48, 64}) {
    const Scene scene = hung_mesh(grid_mesh(n, n, 1, 1), n);
    const Worst found = worst_of(scene, Sweep::multigrid, 6);
    EXPECT_LT(found.p99, 1.015) << n;
    EXPECT_LT(found.largest, 1.1) << n;
    const double tiled = worst_of(scene, Sweep::tiled, 6).p99;
    EXPECT_GT(tiled, 1.05) << n;
    EXPECT_GT(tiled, plain) << "plain sweeps stretch the more";
    plain = tiled;
  }
}

TEST(Multigrid, StretchesNoMoreOnAnIrregularMesh) {
  EXPECT_LT(worst_of(hung_mesh(jittered(48), 48), Sweep::multigrid, 6).p99, 1.015);
  EXPECT_GT(worst_of(hung_mesh(jittered(48), 48), Sweep::tiled, 6).p99, 1.05);
}

TEST(Multigrid, DrapesWithoutPins) {
  const Scene scene = draped(jittered(40));
  EXPECT_LT(worst_of(scene, Sweep::multigrid, 10).p99, 1.02);
  EXPECT_GT(worst_of(scene, Sweep::tiled, 10).p99, 1.05);
}

TEST(Multigrid, LeavesWhatHangsOnSpringsWhereTheirStiffnessSays) {
  for (float compliance : {1e-2f, 1e-3f, 1e-6f}) {
    Scene scene;
    Object line = chain(6, 0.1f, Stiffness::compliance(compliance));
    for (int i = 0; i < 6; ++i) line.positions[std::size_t(i)] = {0, -0.1f * static_cast<float>(i), 0};
    line.damping = 6;
    scene.add(line);
    scene.pin(0, {0});
    scene.settings = settings_of(10, 8);
    scene.settings.sweep = Sweep::multigrid;
    World world(scene);
    for (int frame = 0; frame < 300; ++frame) world.step(1.f / 60);
    double expected = 0, load = 5;
    const std::vector<Vec3f> places = world.object(0).positions();
    for (std::size_t i = 1; i < 6; ++i, --load) {
      expected += 0.1 + load * 9.81 * double(compliance);
      EXPECT_NEAR(-double(places[i].y), expected, 2e-3 * (expected - 0.1 * double(i)) + 2e-6)
          << compliance << ", " << i;
    }
  }
}

/// A sheet pushed along a floor at 1 m/s stops after v^2 / (2 mu g): the correction's tangential springs must not hold
/// it.
TEST(Multigrid, LetsWhatSlidesSlide) {
  Scene scene;
  Object sheet = cotton(grid_mesh(12, 12, 0.3f, 0.3f));
  for (Vec3f& p : sheet.positions) p.y = sheet.thickness;
  sheet.velocities.assign(sheet.positions.size(), {1, 0, 0});
  sheet.static_friction = sheet.kinetic_friction = 0.4f;
  Collider floor;
  floor.static_friction = floor.kinetic_friction = 0.4f;
  scene.add(floor);
  scene.add(sheet);
  scene.settings = settings_of(6);
  scene.settings.sweep = Sweep::multigrid;
  World world(scene);
  const Vec3f before = world.object(0).positions()[60];
  for (int frame = 0; frame < 40; ++frame) world.step(1.f / 60);
  const double way = double(world.object(0).positions()[60].x) - double(before.x);
  EXPECT_NEAR(way, 1 / (2 * 0.4 * 9.81), 0.03 * way);
}

/// Cloth falls on a rough box, corners included. If the friction that contacts take over from the correction exceeded
/// the Coulomb limit, the cloth would tear.
TEST(Multigrid, IsNotTornByWhatFrictionHolds) {
  const Scene scene = on_a_box();
  for (int substeps : {4, 10}) {
    const Worst worst = worst_of(scene, Sweep::multigrid, substeps);
    EXPECT_LT(worst.p99, 1.05) << substeps;
    EXPECT_LT(worst.largest, 1.6) << substeps;
  }
}

TEST(Multigrid, FollowsPinsThatMove) {
  constexpr int n = 32;
  Scene scene = hung_mesh(grid_mesh(n, n, 1, 1), n);
  for (Pin& pin : scene.objects[0].pins) pin.motion = straight({0.5f, 0.3f, 0}, 0.5f);
  EXPECT_LT(worst_of(scene, Sweep::multigrid, 6, 40).p99, 1.02);
}

TEST(Multigrid, CyclesOutOfRangeAreRefusedByName) {
  Scene scene = hung_mesh(grid_mesh(4, 4, 1, 1), 4);
  scene.settings.sweep = Sweep::multigrid;
  for (int cycles : {0, -1, 101}) {
    scene.settings.sweep_options.multigrid_cycles = cycles;
    try {
      const World world(scene);
      FAIL() << cycles;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("multigrid_cycles"), std::string::npos) << error.what();
    }
  }
}

/// Objects without distances, or without dynamic particles, are solved as by `tiled`, forwards and backwards.
TEST(Multigrid, TakesObjectsWithNothingToCorrect) {
  Scene scene;
  scene.add(loose_particles({{0, 0, 0}, {1, 0, 0}}));
  Object fixed = chain(3, 0.1f);
  fixed.pins = {{0, {}}, {1, {}}, {2, {}}};
  scene.add(fixed);
  scene.add(chain(2, 0.1f));
  scene.settings = settings_of(4);
  scene.settings.sweep = Sweep::multigrid;
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
  for (int object : {0, 2}) EXPECT_NEAR(double(world.object(object).positions()[1].y), -0.5 * 9.81, 0.03);
  EXPECT_EQ(world.object(1).positions()[1].y, 0);
}

}  // namespace
}  // namespace pliant
