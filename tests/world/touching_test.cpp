// Tests surfaces at distance 0 at the start, or inside a closed surface: inspect() names them, and a World rejects them
// if the scene says so.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "pliant/error.h"
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

}  // namespace
}  // namespace pliant
