// Tests the sheets that fall over meshes, and that the table of scenes counts what passes through what.
#include "apps/bench/scene_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "apps/bench/bending_energy.h"
#include "apps/bench/draped_meshes.h"
#include "apps/bench/known_sags.h"
#include "pliant/error.h"
#include "support/paths.h"

namespace pliant::bench {
namespace {

TEST(DrapedMeshes, AMeshOfAnySizeStandsOnTheGroundUnderTheSheet) {
  TriangleMesh mesh = sphere_mesh(2);
  for (Vec3f& p : mesh.positions) p = {40 * p.x + 7, 20 * p.y - 3, 30 * p.z};
  const Scene scene = draped_mesh(mesh);
  ASSERT_EQ(scene.objects.size(), 1U);
  ASSERT_EQ(scene.mesh_colliders.size(), 1U);
  Vec3f low{9, 9, 9}, high{-9, -9, -9};
  for (const Vec3f& p : scene.mesh_colliders[0].mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  EXPECT_NEAR(high.x - low.x, 0.5, 1e-5) << "the longest extent is half a metre";
  EXPECT_NEAR(high.x + low.x, 0, 1e-5);
  EXPECT_NEAR(low.y, 0, 1e-5);
  EXPECT_EQ(scene.objects[0].positions.size(), 10000U);
  for (const Vec3f& p : scene.objects[0].positions) EXPECT_NEAR(p.y, high.y + 0.02f, 1e-5);
  EXPECT_TRUE(scene.objects[0].self_collision);
  EXPECT_EQ(scene.settings.sweep, Sweep::automatic);
  EXPECT_EQ(scene.settings.substeps, 0);
}

TEST(DrapedMeshes, AFolderWithoutMeshesIsRefused) {
  for (const std::string& folder : {test::in_tree("docs"), test::in_tree("no_such_folder")}) {
    try {
      draped_meshes(folder);
      FAIL() << folder;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("holds no mesh"), std::string::npos) << error.what();
    }
  }
}

TEST(DrapedMeshes, EachMeshOfAFolderBecomesASceneInOrderOfItsPath) {
  const std::vector<NamedScene> scenes = draped_meshes(test::in_tree("scenes/contact"));
  ASSERT_GE(scenes.size(), 2U);
  EXPECT_TRUE(std::is_sorted(scenes.begin(), scenes.end(),
                             [](const NamedScene& a, const NamedScene& b) { return a.name < b.name; }));
  EXPECT_TRUE(std::any_of(scenes.begin(), scenes.end(), [](const NamedScene& s) { return s.name == "ring.obj"; }));
}

/// A horizontal sheet that falls past a fixed vertical one, which it crosses from the start unless `apart`.
NamedScene crossing(bool apart) {
  Scene scene;
  scene.frames = 1;
  TriangleMesh upright = grid_mesh(5, 5, 1, 1);
  for (Vec3f& p : upright.positions) p = {apart ? p.x + 3 : p.x, p.z, 0.03f};
  scene.add_cloth(grid_mesh(5, 5, 1, 1));
  ClothOptions options;
  options.name = "upright";
  scene.add_cloth(upright, options);
  return {"crossing", scene};
}

TEST(SceneTable, CrossingsAreCountedOnRequest) {
  SceneTableOptions options;
  options.against.clear();
  EXPECT_EQ(measure_scenes({crossing(false)}, options).front().crossings, -1);
  options.counts_crossings = true;
  EXPECT_GT(measure_scenes({crossing(false)}, options).front().crossings, 0);
  EXPECT_EQ(measure_scenes({crossing(true)}, options).front().crossings, 0);
}

SceneRow row(const std::string& settings, double milliseconds, double p99, double largest) {
  SceneRow made{"scene", settings};
  made.milliseconds = milliseconds;
  made.p99 = p99;
  made.largest = largest;
  return made;
}

TEST(SceneTable, NamesTheCheapestSettingThatHoldsTheBounds) {
  std::vector<SceneRow> rows{row("default", 6, 0.01, 0.05),   row("own", 1, 0, 0),
                             row("tiled 20", 2, 0.021, 0.05), row("chains 20", 3, 0.01, 0.11),
                             row("chains 40", 5, 0, 0),       row("chains 30", 4, 0.02, 0.1)};
  compare_costs(rows);
  EXPECT_EQ(rows[0].cheapest, "chains 30");
  EXPECT_EQ(rows[0].ratio, 1.5);
  EXPECT_EQ(rows[5].cheapest, "");
  for (std::size_t i = 2; i < rows.size(); ++i) rows[i].crossings = 1;
  rows[0].cheapest.clear();
  compare_costs(rows);
  EXPECT_EQ(rows[0].cheapest, "") << "none holds";
  rows[4].crossings = 0;
  rows[4].finite = false;
  compare_costs(rows);
  EXPECT_EQ(rows[0].cheapest, "");
}

/// Two hinges, one bent by 90 degrees at rest and one flat.
TEST(BendingEnergy, IsHalfTheSquareOfTheAngleOverTheCompliance) {
  for (const float height : {0.f, 1.f}) {
    Scene scene;
    Object& hinge = scene.objects.emplace_back();
    hinge.positions = {{0, 0, 0}, {1, 0, 0}, {0.3f, 0, 1}, {0.4f, height, height > 0 ? 0.f : -1.f}};
    hinge.masses.assign(4, 1);
    hinge.constraints.push_back({"dihedral_bending", {0, 1, 2, 3}, {0.f}, Stiffness::compliance(0.05f), {}});
    const World world(scene);
    const double bent = height > 0 ? 1.5707963267948966 : 0;
    EXPECT_NEAR(BendingEnergy(scene).of(world), 0.5 * bent * bent / 0.05, 1e-5);
    scene.objects[0].constraints[0].rest.clear();
    EXPECT_EQ(BendingEnergy(scene).of(world), 0) << "the angle at rest is the measured one";
    scene.objects[0].constraints[0].stiffness = Stiffness::rigid();
    EXPECT_EQ(BendingEnergy(scene).of(world), 0);
  }
}

/// What a bent strip gives back is no gain.
TEST(SceneTable, CountsWhatFoldsGiveBackApart) {
  NamedScene strip{"strip", {}};
  ClothOptions stiff;
  stiff.material.bending_stiffness = 1e-3f;
  strip.scene.add_cloth(grid_mesh(5, 40, 0.1f, 1), stiff);
  strip.scene.gravity = {};
  Object& sheet = strip.scene.objects[0];
  for (ConstraintGroup& group : sheet.constraints)
    if (group.type == "dihedral_bending") group.rest.assign(group.particles.size() / 4, 0);
  for (Vec3f& p : sheet.positions) {
    const float angle = 3 * p.z;
    p = {p.x, (1 - std::cos(angle)) / 3, std::sin(angle) / 3};
  }
  SceneTableOptions options;
  options.against.clear();
  options.frames = 60;
  const SceneRow row = measure_scenes({strip}, options).front();
  EXPECT_GT(row.gain, 1e-3);
  EXPECT_LT(row.gain_with_bending, 0.25 * row.gain);
}

/// A field that lifts a sheet by 20 m/s^2 against gravity: its work is energy gained.
TEST(SceneTable, MeasuresEnergyGainedAndMotion) {
  NamedScene lifted{"lifted", {}};
  lifted.scene.add_cloth(grid_mesh(12, 12, 1, 1));
  lifted.scene.gravity = {0, -9.81f, 0};
  lifted.scene.forces.push_back([](const Vec3f&, const Vec3f&, float mass, float) { return Vec3f{0, 20 * mass, 0}; });
  SceneTableOptions options;
  options.against.clear();
  options.frames = 30;
  const SceneRow row = measure_scenes({lifted}, options).front();
  const double seconds = 30 * static_cast<double>(lifted.scene.frame_time), rise = 0.5 * 10.19 * seconds * seconds;
  EXPECT_NEAR(row.moved, rise / 30, 0.02 * rise / 30);
  EXPECT_NEAR(row.gain, 20 * rise, 0.02 * 20 * rise);
  EXPECT_TRUE(row.finite);
}

TEST(SceneTable, LeavesTheBoundsOfTheFileToItsOwnSettings) {
  NamedScene hung{"hung", {}};
  hung.scene.add_cloth(grid_mesh(24, 24, 1, 1));
  hung.scene.pin(0, {0});
  hung.scene.objects[0].self_collision = true;
  hung.scene.settings.least_substeps = hung.scene.settings.most_substeps = 60;
  SceneTableOptions options;
  options.against = {"own"};
  options.frames = 2;
  const std::vector<SceneRow> rows = measure_scenes({hung}, options);
  EXPECT_EQ(rows[1].substeps, 60);
  EXPECT_LT(rows[0].substeps, 59);
  EXPECT_EQ(rows[0].frames, 2);
}

/// The scenes that `pliant bench default` measures by itself: their default settings are right.
TEST(KnownSags, AreRightByDefault) {
  SceneTableOptions options;
  options.against.clear();
  const std::vector<SceneRow> rows = measure_scenes(known_sags(), options);
  ASSERT_EQ(rows.size(), 4U);
  for (const SceneRow& row : rows) EXPECT_NEAR(row.yield, 1, 0.04) << row.scene;
}

}  // namespace
}  // namespace pliant::bench
