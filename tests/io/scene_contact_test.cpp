// Tests contact in scene files: members of objects, mesh colliders and groups, and the generated surfaces.
#include <algorithm>
#include <cmath>
#include <map>

#include "io/scene_mesh.h"
#include "scene_support.h"

namespace pliant {
namespace {

using test::scene_message;

class FullContact : public testing::Test {
 protected:
  const Scene scene = parse_scene(test::full_scene(), "every_field.json", ".");
};

TEST_F(FullContact, IsSaidOfObjects) {
  const Object &sheet = scene.objects.at(0), &plain = scene.objects.at(1);
  EXPECT_TRUE(sheet.self_collision);
  EXPECT_TRUE(sheet.collides);
  EXPECT_EQ(sheet.groups, 0x80000001U);
  EXPECT_EQ(sheet.mask, 4U);
  EXPECT_FALSE(plain.self_collision);
  EXPECT_FALSE(plain.collides);
  EXPECT_EQ(plain.groups, Object{}.groups);
  EXPECT_EQ(plain.mask, Object{}.mask);
  EXPECT_FALSE(scene.settings.contact_filter);
  EXPECT_TRUE(parse_scene(R"({"objects": []})", "x.json", ".").settings.contact_filter);
}

TEST_F(FullContact, HasItsMeshColliders) {
  ASSERT_EQ(scene.colliders.size(), 5U) << "meshes are kept apart from primitives";
  ASSERT_EQ(scene.mesh_colliders.size(), 5U);
  const MeshCollider& box = scene.mesh_colliders[0];
  EXPECT_EQ(box.name, "mesh");
  EXPECT_EQ(scene.mesh_colliders[1].name, "mesh_2");
  // A box of 1 x 2 x 3 after scaling, rotated by 90 degrees about y and moved along z by 1.
  Vec3f low = box.mesh.positions.front(), high = low;
  for (const Vec3f& p : box.mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  EXPECT_LE(length_squared(low - Vec3f{-1.5f, -1, 0.5f}), 1e-10f);
  EXPECT_LE(length_squared(high - Vec3f{1.5f, 1, 1.5f}), 1e-10f);
  EXPECT_EQ(box.motion.keyframes.size(), 2U);
  EXPECT_EQ(box.thickness, 0.25f);
  EXPECT_EQ(box.static_friction, 0.75f);
  EXPECT_EQ(box.kinetic_friction, 0.5f);
  EXPECT_EQ(box.groups, 8U);
  EXPECT_EQ(box.mask, 0U);
  EXPECT_EQ(box.colour, (Vec3f{0, 0.5f, 1}));
}

TEST_F(FullContact, SaysWhatStandsForAMesh) {
  EXPECT_EQ(scene.mesh_colliders.at(0).as, MeshCollider::As::distance_grid);
  EXPECT_EQ(scene.mesh_colliders.at(0).grid_spacing, 0.25f);
  EXPECT_EQ(scene.mesh_colliders.at(0).restitution, 0.125f);
  EXPECT_LT(length_squared(scene.mesh_colliders.at(0).surface_velocity - Vec3f{0, 0, -1}), 1e-12f)
      << "turned with the mesh";
  EXPECT_EQ(scene.mesh_colliders.at(1).as, MeshCollider::As::heightfield);
  EXPECT_EQ(scene.mesh_colliders.at(2).as, MeshCollider::As::triangles);
}

TEST_F(FullContact, HasFramesPlacedAsTheMeshIs) {
  const MeshCollider& wing = scene.mesh_colliders.at(3);
  ASSERT_EQ(wing.frames.size(), 2U);
  EXPECT_EQ(wing.frames[0].time, 0.5f);
  EXPECT_EQ(wing.frames[1].time, 1.5f);
  EXPECT_EQ(wing.frames[1].positions.at(3), (Vec3f{2, 2, 5}));
  EXPECT_TRUE(wing.repeat_frames);
}

TEST_F(FullContact, KnowsWhatPairsAre) {
  ASSERT_EQ(scene.pairs.size(), 2U);
  EXPECT_EQ(scene.pairs[0].first, "sheet");
  EXPECT_EQ(scene.pairs[0].second, "hare");
  EXPECT_EQ(scene.pairs[0].thickness, 0.0625f);
  EXPECT_EQ(scene.pairs[0].static_friction, 0.5f);
  EXPECT_EQ(scene.pairs[0].kinetic_friction, 0.25f);
  EXPECT_EQ(scene.pairs[0].restitution, 0.75f);
  EXPECT_FALSE(scene.pairs[1].thickness || scene.pairs[1].static_friction);
  EXPECT_EQ(scene.settings.most_substeps, 321);
  EXPECT_EQ(scene.settings.initial_intersections, Settings::Intersections::untangle);
  EXPECT_EQ(scene.settings.integrator, Settings::Integrator::energy);
  EXPECT_EQ(scene.settings.untangling_speed, 0.25f);
  EXPECT_TRUE(scene.settings.sleep.on);
  EXPECT_EQ(scene.settings.sleep.speed, 0.0625f);
  EXPECT_EQ(scene.settings.sleep.spin, 0.125f);
  EXPECT_EQ(scene.settings.sleep.time, 0.75f);
}

/// The longest side of a mesh's bounding box, and its lowest point.
std::pair<float, float> extent(const TriangleMesh& mesh) {
  Vec3f low = mesh.positions.front(), high = low;
  for (const Vec3f& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return {std::max({high.x - low.x, high.y - low.y, high.z - low.z}), low.y};
}

TEST_F(FullContact, FitsMeshes) {
  const auto [longest, lowest] = extent(scene.mesh_colliders.at(4).mesh);
  EXPECT_NEAR(longest, 2, 1e-5);
  EXPECT_NEAR(lowest, 0, 1e-5);
}

TEST(SceneSurfaces, RabbitsAreClosedAndFaceOutwards) {
  for (const int cells : {16, 20, 25, 29, 36, 40, 48}) {  // some need another grid offset
    const TriangleMesh rabbit = scene_file::rabbit_mesh(0.3f, cells);
    for (const Finding& found : inspect(rabbit)) {
      EXPECT_FALSE(found.grave) << cells << " cells: " << found.message;
      EXPECT_EQ(found.message.find("boundary"), std::string::npos) << cells << " cells: " << found.message;
      EXPECT_EQ(found.message.find("edge"), std::string::npos) << cells << " cells: " << found.message;
    }
    double six_volumes = 0;
    for (const auto& t : rabbit.triangles) {
      const auto at = [&](int i) { return rabbit.positions[static_cast<std::size_t>(i)]; };
      six_volumes += static_cast<double>(dot(cross(at(t[0]), at(t[1])), at(t[2])));
    }
    EXPECT_GT(six_volumes / 6, 0.3 * 0.3 * 0.3 * 0.05);
    const auto [longest, lowest] = extent(rabbit);
    EXPECT_NEAR(longest, 0.3, 1e-6);
    EXPECT_NEAR(lowest, 0, 1e-7);
  }
}

TEST_F(FullContact, HasItsHeightfields) {
  const TriangleMesh& steps = scene.mesh_colliders.at(1).mesh;
  ASSERT_EQ(steps.positions.size(), 6U);
  EXPECT_EQ(steps.triangles.size(), 4U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(steps.positions[i].y, static_cast<float>(i + 1));
  const TriangleMesh& hills = scene.mesh_colliders.at(2).mesh;
  ASSERT_EQ(hills.positions.size(), 25U);
  for (const Vec3f& p : hills.positions) {
    const double expected = 0.5 * std::sin(2 * M_PI * double(p.x) / 4) * std::sin(2 * M_PI * double(p.z) / 4);
    EXPECT_NEAR(p.y, expected, 1e-6) << p.x << " " << p.z;
  }
}

/// Every edge has two triangles that traverse it in opposite directions, and all triangles face outward.
TEST(SceneSurfaces, BoxesAreClosedAndFaceOutwards) {
  for (const int segments : {1, 2, 5}) {
    const TriangleMesh box = scene_file::box_mesh({2, 3, 4}, segments);
    std::map<std::pair<int, int>, int> sides;
    double six_volumes = 0;
    for (const auto& t : box.triangles) {
      for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
      const auto at = [&](int i) { return box.positions[static_cast<std::size_t>(i)]; };
      six_volumes += static_cast<double>(dot(cross(at(t[0]), at(t[1])), at(t[2])));
    }
    for (const auto& [side, count] : sides) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(sides.count({side.second, side.first}), 1U);
    }
    EXPECT_EQ(box.triangles.size(), static_cast<std::size_t>(12 * segments * segments));
    EXPECT_EQ(box.positions.size(), static_cast<std::size_t>(6 * segments * segments + 2));
    EXPECT_NEAR(six_volumes, 6 * 24, 1e-4);
  }
}

TEST(SceneMeshes, MayComeFromElsewhereByName) {
  const std::string folder = testing::TempDir() + "pliant_elsewhere";
  std::filesystem::create_directories(folder);
  const std::string scene = folder + "/a.json", mesh = folder + "/tetrahedron.obj";
  std::ofstream(scene)
      << R"({"objects": [], "colliders": [{"name": "body", "mesh": {"rabbit": {"cells": 16}, "fit": 2}}]})";
  std::ofstream(mesh) << "v 0 0 0\nv 8 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const SceneFile file = read_scene_file(scene, SceneReadOptions{false, {{"body", mesh}}});
  const TriangleMesh& body = file.scene.mesh_colliders.at(0).mesh;
  ASSERT_EQ(body.positions.size(), 4U);
  EXPECT_EQ(body.positions[1], (Vec3f{1, 0, -0.5f}))
      << "fitted as the scene says: 8 m are 2, and the middle is above the origin";
}

/// The error of reading a scene file if this name is given a mesh.
std::string error_of_mesh_for(const std::string& name, const std::string& scene) {
  const std::string folder = testing::TempDir() + "pliant_elsewhere_refused";
  std::filesystem::create_directories(folder);
  const std::string path = folder + "/a.json", mesh = folder + "/triangle.obj";
  std::ofstream(path) << scene;
  std::ofstream(mesh) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  try {
    read_scene_file(path, SceneReadOptions{false, {{name, mesh}}});
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(SceneMeshes, FromElsewhereAreForNamesThatHaveOne) {
  const std::string grid = R"("mesh": {"grid": {"columns": 2, "rows": 2, "width": 1, "depth": 1}})";
  const std::string scene = R"({"objects": [{"name": "shirt", "cloth": {)" + grid + R"(}}, {"cloth": {)" + grid +
                            R"(}}, {"name": "leash", "rope": {"points": [[0, 0, 0], [0, 1, 0]]}}],
                            "colliders": [{"name": "body", )" +
                            grid + R"(}, {"name": "floor", "plane": {}}]})";
  const auto ends = [](const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
  };
  EXPECT_EQ(error_of_mesh_for("body", scene), "");
  EXPECT_EQ(error_of_mesh_for("cloth", scene), "") << "the one without a name of its own";
  const std::string all = "the scene has meshes for 'shirt', 'cloth', 'body'";
  for (const char* name : {"leash", "floor", "nobody_here"}) {
    const std::string error = error_of_mesh_for(name, scene);
    EXPECT_TRUE(ends(error, "nothing with a mesh is called '" + std::string(name) + "'; " + all)) << error;
  }
  const std::string misspelt = error_of_mesh_for("shrit", scene);
  EXPECT_TRUE(ends(misspelt, "; did you mean 'shirt'? " + all)) << misspelt;
  const std::string none = error_of_mesh_for("shirt", R"({"objects": []})");
  EXPECT_TRUE(ends(none, "; nothing in this scene has a mesh")) << none;
}

TEST(SceneMeshes, DeformByFiles) {
  const std::string folder = testing::TempDir() + "pliant_frames";
  std::filesystem::create_directories(folder);
  // Two vertices at one position: they are merged in a rigid mesh, and kept in a deforming one.
  const auto write = [&](const std::string& name, float height) {
    std::ofstream(folder + "/" + name) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 " << height
                                       << " 1\nf 1 2 3\nf 4 5 6\n";
  };
  write("a.obj", 0);
  write("b.obj", 3);
  const Scene scene = parse_scene(
      R"({"objects": [], "colliders": [{"mesh": {"file": "a.obj", "scale": 2}, "position": [1, 0, 0],
          "frames": [{"time": 0, "file": "a.obj"}, {"time": 1, "file": "b.obj"}]}]})",
      "x.json", folder, false);
  const MeshCollider& one = scene.mesh_colliders.at(0);
  ASSERT_EQ(one.mesh.positions.size(), 6U);
  ASSERT_EQ(one.frames.at(1).positions.size(), 6U);
  EXPECT_EQ(one.frames[1].positions[5], (Vec3f{1, 6, 2}));
  EXPECT_EQ(one.frames[0].positions[5], one.mesh.positions[5]);
}

TEST(SceneContact, OfRopesReads) {
  const Scene scene = parse_scene(
      R"({"objects": [{"rope": {"points": [[0,0,0],[0,1,0]]}, "self_collision": true, "collides": true, "thickness": 0.01}]})",
      "x.json", ".");
  EXPECT_TRUE(scene.objects[0].self_collision);
  EXPECT_TRUE(scene.objects[0].collides);
  EXPECT_EQ(scene.objects[0].thickness, 0.01f);
}

std::string with_collider(const std::string& collider) { return R"({"objects": [], "colliders": [)" + collider + "]}"; }

TEST(SceneContact, IsRefusedInItsWords) {
  EXPECT_EQ(scene_message(with_collider(R"({"sphere": {}, "groups": [1]})")),
            "x.json:1:46: /colliders/0/groups: 'groups' has no meaning here; remove it");
  EXPECT_EQ(scene_message(with_collider(R"({"sphere": {}, "as": "heightfield"})")),
            "x.json:1:46: /colliders/0/as: 'as' has no meaning here; remove it");
  EXPECT_NE(scene_message(with_collider(R"({"mesh": {"sphere": {"subdivisions": 0}}, "grid_spacing": 1})"))
                .find("only a distance grid has a spacing"),
            std::string::npos);
  EXPECT_NE(scene_message(
                with_collider(
                    R"({"mesh": {"sphere": {"subdivisions": 0}}, "frames": [{"time": 0, "positions": [[0,0,0]]}]})"))
                .find("this frame has 1 vertices, the mesh 12"),
            std::string::npos);
  EXPECT_NE(
      scene_message(R"({"objects": [], "pairs": [{"between": ["a", "b"]}]})").find("no object or mesh collider 'a'"),
      std::string::npos);
  EXPECT_NE(scene_message(with_collider(R"({"mesh": {"file": "no_such.obj"}})")).find("there is no file"),
            std::string::npos);
  EXPECT_NE(scene_message(R"({"objects": [{"rope": {"points": [[0,0,0],[0,1,0]]}, "groups": [32]}]})")
                .find("32 is out of range; expected an integer from 0 to 31"),
            std::string::npos);
  EXPECT_NE(
      scene_message(
          with_collider(
              R"({"mesh": {"heightfield": {"columns": 2, "rows": 2, "width": 1, "depth": 1, "heights": [1,2,3,4,5]}}})"))
          .find("5 heights for 4 vertices"),
      std::string::npos);
  EXPECT_NE(scene_message(
                with_collider(R"({"name": "a", "plane": {}}, {"name": "a", "mesh": {"sphere": {"subdivisions": 0}}})"))
                .find("the name 'a' is taken"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
