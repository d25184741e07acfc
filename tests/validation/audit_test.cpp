// Tests the auditor: it must detect what passes through, and measure what brute force measures. Small versions of the
// long contact scenes must do what the large ones are for.
#include "apps/validate/audit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "apps/validate/long_contact.h"
#include "geometry/triangle.h"
#include "topology/edges.h"

namespace pliant::validate {
namespace {

TEST(Audit, FindsNothingWhereTheEngineKeepsItsPromise) {
  for (const Scene& scene : {folded_scene(12), layered_scene(5), twisted_scene(10), ball_scene(12)}) {
    const Audit audit = audit_surfaces(scene, 40);
    EXPECT_TRUE(audit.ok);
    EXPECT_EQ(audit.most, 0U);
    EXPECT_EQ(audit.first, -1);
    EXPECT_EQ(audit.unresolvable, 0);
    EXPECT_EQ(audit.frames, 40);
    EXPECT_GT(audit.least_distance, 0);
  }
}

// If the ends did not come nearer as they rotate, the sheet between would tear, and its contacts would say nothing
// about cloth.
TEST(Audit, TwistsWithoutTearing) {
  Scene scene = twisted_scene(16);
  scene.settings.measure = true;
  World world(scene);
  double longest = 0;
  std::int64_t contacts = 0;
  for (int frame = 0; frame < 480; ++frame) {
    const Report report = world.step(scene.frame_time);
    longest = std::max(longest, report.stretch->p99);
    contacts += report.pairs.contacts;
  }
  EXPECT_LT(longest, 1.2);
  EXPECT_GT(contacts, 1000);
}

TEST(Audit, SeesSurfacesThatPassThroughOneAnother) {
  Scene scene = layered_scene(6);
  for (Object& object : scene.objects) object.self_collision = object.collides = false;
  const Audit audit = audit_surfaces(scene, 40);
  EXPECT_GT(audit.most, 20U);
  EXPECT_GT(audit.first, 0);
  EXPECT_EQ(audit.unresolvable, 0);
}

TEST(Audit, SeesABallThatPassesThroughASheet) {
  Scene scene = ball_scene(24);
  scene.mesh_colliders[0].mask = 0;
  EXPECT_GT(audit_surfaces(scene, 40).most, 10U);
}

// Without self-collision the rope leaves its knot by passing through itself, which only the paths between frames show.
TEST(Audit, SeesARopeThatPassesThroughItself) {
  Scene scene = knot_scene();
  Audit audit = audit_rope(scene, 250);
  EXPECT_TRUE(audit.ok);
  EXPECT_EQ(audit.most, 0U);
  EXPECT_NEAR(audit.least_distance, 0.006, 0.001);
  scene.objects[0].self_collision = false;
  audit = audit_rope(scene, 250);
  EXPECT_GT(audit.most, 0U);
  EXPECT_LT(audit.least_distance, 0.001);
}

/// The least distance over all vertices and triangles, and all edges, that have no vertex in common.
double brute_force(const std::vector<Triangle>& triangles, const std::vector<Vec3f>& places) {
  const auto at = [&](int vertex) { return convert<double>(places[static_cast<std::size_t>(vertex)]); };
  double least = 1e300;
  for (const Triangle& t : triangles)
    for (int v = 0; v < static_cast<int>(places.size()); ++v)
      if (v != t[0] && v != t[1] && v != t[2])
        least = std::min(least, closest_on_triangle(at(v), at(t[0]), at(t[1]), at(t[2])).distance_squared);
  const std::vector<Edge> edges = find_edges(triangles, static_cast<int>(places.size()));
  for (const Edge& e : edges)
    for (const Edge& f : edges)
      if (e.a != f.a && e.a != f.b && e.b != f.a && e.b != f.b)
        least = std::min(least, closest_on_segments<double>({at(e.a), at(e.b)}, {at(f.a), at(f.b)}).distance_squared);
  return std::sqrt(least);
}

TEST(Audit, MeasuresTheLeastDistanceOfBruteForce) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int trial = 0; trial < 40; ++trial) {
    TriangleMesh mesh = grid_mesh(5, 4, 1, 1);
    for (Vec3f& p : mesh.positions) {
      const float x = uniform(random), y = uniform(random), z = uniform(random);
      p += Vec3f{x, y, z} * (trial % 2 == 0 ? 0.05f : 0.6f);
    }
    const std::vector<Triangle> triangles(mesh.triangles.begin(), mesh.triangles.end());
    EXPECT_NEAR(least_distance({mesh.positions, triangles}, 5), brute_force(triangles, mesh.positions), 1e-12);
    EXPECT_EQ(least_distance({mesh.positions, triangles}, 1e-9),
              std::min(1e-9, brute_force(triangles, mesh.positions)));
  }
}

}  // namespace
}  // namespace pliant::validate
