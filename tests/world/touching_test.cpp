// Tests surfaces at distance 0 at the start, or inside a closed surface: inspect() names them, a World rejects them if
// the scene says so, and else holds them on the side of the normals of what is fixed for them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "pliant/error.h"
#include "pliant/soft_body.h"
#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;
using Intersections = Settings::Intersections;

/// A sheet at height `above` over a level one, which is cloth or a mesh collider.
Scene lying(float above, bool on_cloth) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.add(named_cloth(sheet(5, 0.2f, above), "upper"));
  if (on_cloth) {
    scene.add(named_cloth(sheet(5, 0.2f, 0), "lower"));
  } else {
    MeshCollider table;
    table.name = "table";
    table.mesh = sheet(3, 0.6f, 0);
    scene.add(table);
  }
  return scene;
}

bool says(const Scene& scene, const std::string& words) {
  const std::vector<Finding> findings = inspect(scene);
  return std::any_of(findings.begin(), findings.end(),
                     [&](const Finding& finding) { return finding.message.find(words) != std::string::npos; });
}

std::string refusal_of_intersecting(Scene scene) {
  scene.settings.initial_intersections = Intersections::refuse;
  return refusal_of(scene);
}

TEST(Touching, IsNamedAndRefused) {
  for (const bool on_cloth : {false, true}) {
    const std::string other = on_cloth ? "object 'lower'" : "collider 'table'";
    EXPECT_TRUE(says(lying(0, on_cloth), "starts nearer to " + other));
    EXPECT_TRUE(says(lying(0, on_cloth), "the nearest 0 m from it"));
    EXPECT_NE(refusal_of_intersecting(lying(0, on_cloth)).find("of " + other + " at the start, at a distance of 0"),
              std::string::npos)
        << refusal_of_intersecting(lying(0, on_cloth));
    EXPECT_EQ(refusal_of_intersecting(lying(1e-4f, on_cloth)), "");
  }
}

TEST(Touching, OfOnePartIsNoMatter) {
  TriangleMesh seam = sheet(5, 0.2f, 0);
  const TriangleMesh second = seam;
  for (const Vec3f& p : second.positions) seam.positions.push_back(p + Vec3f{0.2f, 0, 0});
  for (const auto& t : second.triangles) seam.triangles.push_back({t[0] + 25, t[1] + 25, t[2] + 25});
  Scene scene;
  scene.add(named_cloth(seam, "seam"));
  EXPECT_EQ(refusal_of_intersecting(scene), "");
}

TEST(Touching, WhatIsInsideAClosedMeshIsDoubted) {
  Scene scene;
  scene.add(named_cloth(sheet(4, 0.2f, 0.03f), "sheet"));
  MeshCollider ball;
  ball.name = "ball";
  ball.mesh = sphere_mesh(2);
  scene.add(ball);
  EXPECT_TRUE(says(scene, "is inside of closed collider 'ball' at the start"));
  for (Vec3f& p : scene.objects[0].positions) p.y += 3;
  EXPECT_FALSE(says(scene, "is inside of"));
}

// ------------------------------------------------------------------------------------------------ held on a side

/// Runs a second. Expects no crossing after any frame, and no warning.
void run_held(const Scene& scene, World& world) {
  Watch watch(world, scene);
  std::size_t most = 0;
  for (int frame = 0; frame < 60; ++frame) {
    const Report report = world.step(1.f / 60);
    for (const std::string& warning : report.warnings) ADD_FAILURE() << warning;
    most = std::max(most, watch.crossings(world));
  }
  EXPECT_EQ(most, 0u);
}

struct Heights {
  float lowest = 1e9f, highest = -1e9f;
};

Heights heights(const World& world, int object) {
  Heights out;
  for (const Vec3f& p : world.object(object).positions()) {
    out.lowest = std::min(out.lowest, p.y);
    out.highest = std::max(out.highest, p.y);
  }
  return out;
}

TriangleMesh turned_over(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// The normal says on which side, so a mesh that is turned over holds the sheet below it.
TEST(TouchingStart, IsHeldByAMeshOnTheSideOfItsNormal) {
  for (const bool is_over : {true, false}) {
    Scene scene = lying(0, false);
    if (!is_over) {
      scene.mesh_colliders[0].mesh = turned_over(scene.mesh_colliders[0].mesh);
      scene.gravity = -scene.gravity;
    }
    World world(scene);
    run_held(scene, world);
    const auto [lowest, highest] = heights(world, 0);
    EXPECT_GT(is_over ? lowest : -highest, 1e-4f);
    EXPECT_LT(is_over ? highest : -lowest, 0.006f) << "thrown";
  }
}

/// As of a sheet on an inclined mesh, where vertices are on either side of it by rounding.
TEST(TouchingStart, IsHeldWhereRoundingDecides) {
  Scene scene = lying(0, false);
  const float c = std::cos(0.3f), s = std::sin(0.3f);
  const auto incline = [&](std::vector<Vec3f>& places) {
    for (Vec3f& p : places) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  };
  incline(scene.objects[0].positions);
  incline(scene.mesh_colliders[0].mesh.positions);
  scene.objects[0].static_friction = scene.objects[0].kinetic_friction = 1;
  scene.mesh_colliders[0].static_friction = scene.mesh_colliders[0].kinetic_friction = 1;
  World world(scene);
  run_held(scene, world);
  for (const Vec3f& p : world.object(0).positions()) {
    EXPECT_GT(c * p.y - s * p.x, 1e-4f);
    EXPECT_LT(c * p.y - s * p.x, 0.006f);
  }
}

/// Sheets with the same vertices, and with others.
TEST(TouchingStart, OfALaterClothIsHeldAboveAnEarlierOne) {
  for (const int columns : {5, 4}) {
    Scene scene;
    scene.settings = settings_of(4);
    scene.add(Collider{});
    scene.add(named_cloth(sheet(5, 0.2f, 0.01f), "first"));
    scene.add(named_cloth(sheet(columns, columns == 5 ? 0.2f : 0.17f, 0.01f), "second"));
    World world(scene);
    run_held(scene, world);
    EXPECT_GT(heights(world, 1).lowest, heights(world, 0).highest);
    EXPECT_LT(heights(world, 1).highest, 0.015f) << "thrown";
  }
}

TEST(TouchingStart, OfManyLayersKeepsTheirOrder) {
  Scene scene = lying(0, false);
  for (const char* name : {"second", "third", "fourth"}) scene.add(named_cloth(sheet(5, 0.2f, 0), name));
  World world(scene);
  run_held(scene, world);
  for (int layer = 1; layer < 4; ++layer)
    EXPECT_GT(heights(world, layer).lowest, heights(world, layer - 1).highest) << layer;
}

/// The upper half of a ball's own mesh, as a cap that was modelled on it.
TEST(TouchingStart, IsHeldOutsideAClosedBody) {
  for (const bool is_dynamic : {false, true}) {
    TriangleMesh ball = sphere_mesh(2), cap;
    for (Vec3f& p : ball.positions) p = p * 0.1f;
    for (const auto& t : ball.triangles)
      if (std::all_of(t.begin(), t.end(), [&](int v) { return ball.positions[static_cast<std::size_t>(v)].y > 0.01f; }))
        cap.triangles.push_back(t);
    std::vector<int> number(ball.positions.size(), -1);
    for (auto& t : cap.triangles)
      for (int& v : t) {
        int& now = number[static_cast<std::size_t>(v)];
        if (now < 0) {
          now = static_cast<int>(cap.positions.size());
          cap.positions.push_back(ball.positions[static_cast<std::size_t>(v)]);
        }
        v = now;
      }
    Scene scene;
    scene.settings = settings_of(8);
    scene.gravity = {};
    scene.add(named_cloth(cap, "cap"));  // before the ball, which is closed, and so fixed for it
    if (is_dynamic) {
      scene.add(named_cloth(ball, "ball"));
    } else {
      MeshCollider collider;
      collider.mesh = ball;
      scene.add(collider);
    }
    World world(scene);
    run_held(scene, world);
    for (const Vec3f& p : world.object(0).positions()) EXPECT_GT(std::sqrt(length_squared(p)), 0.1001f);
  }
}

/// What hangs from a ceiling does not jump through it, whatever its normals say.
TEST(TouchingStart, StaysOnTheSideOfTheRest) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.gravity = {};
  TriangleMesh curtain = grid_mesh(5, 5, 0.2f, 0.2f);
  for (Vec3f& p : curtain.positions) p = {p.x, p.z - 0.1f, 0.013f};
  scene.add(named_cloth(curtain, "curtain"));
  MeshCollider ceiling;
  ceiling.mesh = sheet(3, 0.6f, 0);
  scene.add(ceiling);
  World world(scene);
  run_held(scene, world);
  EXPECT_LT(heights(world, 0).highest, -1e-4f);
}

TEST(TouchingStart, LeavesPinsAndOtherStartsWhereTheyAre) {
  Scene scene = lying(0, false);
  scene.objects[0].pins = {{0}};
  const Vec3f corner = scene.objects[0].positions[0];
  World pinned(scene);
  EXPECT_EQ(pinned.object(0).positions()[0].y, corner.y);
  EXPECT_GT(pinned.object(0).positions()[12].y, 1e-3f);
  const Scene near = lying(1e-4f, false);
  World world(near);
  for (const Vec3f& p : world.object(0).positions()) EXPECT_EQ(p.y, 1e-4f);
}

TEST(TouchingStart, OfAnAddedObjectIsHeld) {
  Scene scene = lying(0, false);
  World world(scene);
  for (int frame = 0; frame < 5; ++frame) world.step(1.f / 60);
  Object second = named_cloth(sheet(5, 0.2f, 0), "second");
  for (Vec3f& p : second.positions) p.x += 0.21f;
  world.add(second);
  scene.add(second);
  run_held(scene, world);
  EXPECT_GT(heights(world, 1).lowest, 1e-4f);
  EXPECT_LT(heights(world, 1).highest, 0.006f) << "thrown";
}

/// Another layer that is closer than the thickness is no place to go through.
TEST(TouchingStart, DoesNotPassALayerThatIsNear) {
  Scene scene = lying(0, false);
  scene.add(named_cloth(sheet(5, 0.2f, 5e-4f), "above"));
  World world(scene);
  run_held(scene, world);
  EXPECT_GT(heights(world, 1).lowest, heights(world, 0).lowest);
  EXPECT_GT(heights(world, 0).lowest, 0);
}

/// A patch over the middle of a triangle is on the way of none of its corners.
TEST(TouchingStart, DoesNotPassASmallThingOverTheMiddleOfATriangle) {
  Scene scene = lying(0, false);
  scene.objects[0] = named_cloth(sheet(2, 0.2f, 0), "coarse");
  Object patch = named_cloth(sheet(3, 0.01f, 5e-4f), "patch");
  for (Vec3f& p : patch.positions) p += {0.03f, 0, 0.02f};
  scene.add(patch);
  World world(scene);
  EXPECT_GT(heights(world, 1).lowest, heights(world, 0).lowest);
  run_held(scene, world);
  EXPECT_GT(heights(world, 1).lowest, heights(world, 0).lowest);
}

/// A soft body that stands exactly on a mesh is lifted as a whole: squeezed from below, it would jump.
TEST(TouchingStart, OfASoftBodyDoesNotSqueezeIt) {
  Scene scene;
  scene.settings = settings_of(20);
  SoftBodyOptions options;
  options.name = "jelly";
  options.material.youngs_modulus = 2e5f;
  Object jelly = make_soft_body(box_tetrahedra({0.05f, 0.05f, 0.05f}, {3, 3, 3}), options);
  jelly.thickness = 0.004f;
  float lowest = 1;
  for (const Vec3f& p : jelly.positions) lowest = std::min(lowest, p.y);
  for (Vec3f& p : jelly.positions) p.y -= lowest;
  scene.add(jelly);
  MeshCollider table;
  table.name = "table";
  table.mesh = sheet(3, 0.6f, 0);
  scene.add(table);
  World world(scene);
  const std::vector<Vec3f> start = world.object(0).positions();
  const float lifted = start[0].y - jelly.positions[0].y;
  EXPECT_NEAR(lifted, 0.004f, 1e-6f) << "both thicknesses";
  for (std::size_t i = 0; i < start.size(); ++i) EXPECT_NEAR(start[i].y - jelly.positions[i].y, lifted, 1e-6f) << i;
  float fastest = 0;
  for (int frame = 0; frame < 20; ++frame) {
    world.step(1.f / 60);
    for (const Vec3f& v : world.object(0).velocities()) fastest = std::max(fastest, v.y);
  }
  EXPECT_LT(fastest, 0.02f) << "it jumps";
}

TEST(TouchingStart, IsTheSameInAWorldOfItsLayout) {
  const Scene scene = lying(0, true);
  World world(scene);
  for (int frame = 0; frame < 5; ++frame) world.step(1.f / 60);
  World again(scene, world.layout());
  again.restore(world.state());
  for (int frame = 0; frame < 5; ++frame) world.step(1.f / 60), again.step(1.f / 60);
  for (int object = 0; object < 2; ++object) {
    const std::vector<Vec3f> a = world.object(object).positions(), b = again.object(object).positions();
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(a[i].x == b[i].x && a[i].y == b[i].y && a[i].z == b[i].z);
  }
}

/// Between two surfaces of opposed normals neither side is right, so that cloth stays where it is.
TEST(Touching, BetweenOpposedSurfacesStays) {
  Scene scene;
  scene.settings = settings_of(4);
  for (const bool is_up : {true, false}) {
    MeshCollider plate;
    plate.mesh = sheet(3, 0.6f, 0);
    if (!is_up)
      for (auto& t : plate.mesh.triangles) std::swap(t[1], t[2]);
    scene.add(plate);
  }
  scene.add(named_cloth(sheet(5, 0.2f, 0), "cloth"));
  const World world(scene);
  for (const Vec3f& p : world.object(0).positions()) EXPECT_EQ(p.y, 0.f);
}

}  // namespace
}  // namespace pliant
