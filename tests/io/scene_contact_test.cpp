// Contact in scene files: what is said of objects, mesh colliders, groups, and the surfaces that can be asked for.
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
  ASSERT_EQ(scene.mesh_colliders.size(), 3U);
  const MeshCollider& box = scene.mesh_colliders[0];
  EXPECT_EQ(box.name, "mesh");
  EXPECT_EQ(scene.mesh_colliders[1].name, "mesh_2");
  // A box of 1 x 2 x 3 after its scale, turned by 90 degrees about y, moved along z by 1.
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

/// Every edge is of two triangles that run along it in opposite ways, and they all look outwards.
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
  EXPECT_EQ(scene_message(with_collider(R"({"mesh": {"sphere": {"subdivisions": 0}}, "restitution": 0.5})")),
            "x.json:1:73: /colliders/0/restitution: 'restitution' has no meaning here; remove it");
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
  EXPECT_NE(
      scene_message(with_collider(R"({"name": "a", "plane": {}}, {"name": "a", "mesh": {"sphere": {"subdivisions": 0}}})"))
          .find("the name 'a' is taken"),
      std::string::npos);
}

}  // namespace
}  // namespace pliant
