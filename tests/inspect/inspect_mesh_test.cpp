// Tests inspect() for meshes: each finding on the smallest mesh that has it, and none on a valid mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "topology/edges.h"
#include "topology/self_intersection.h"

namespace pliant {
namespace {

const std::vector<Vec3f> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

/// All findings as text, one per line; grave ones are marked.
std::string told(const TriangleMesh& mesh) {
  std::string text;
  for (const Finding& finding : inspect(mesh)) {
    EXPECT_FALSE(finding.advice.empty()) << finding.message;
    text += (finding.grave ? "GRAVE " : "") + finding.message + "\n";
  }
  return text;
}

testing::AssertionResult tells(const TriangleMesh& mesh, const std::string& part) {
  const std::string text = told(mesh);
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << text << "' does not contain '" << part << "'";
}

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TriangleMesh moved(TriangleMesh mesh, const Vec3f& by) {
  for (Vec3f& p : mesh.positions) p += by;
  return mesh;
}

TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  const int first = static_cast<int>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

TEST(Inspect, TellsNothingOfAMeshWithoutFault) {
  EXPECT_EQ(told(sphere_mesh(3)), "");
  EXPECT_EQ(told(tetrahedron()), "");
  EXPECT_EQ(told(moved(tetrahedron(), {1000, -1000, 3000})), "");
}

TEST(Inspect, TellsTheBordersOfACloth) {
  EXPECT_EQ(told(grid_mesh(5, 4, 1, 1)), "open, with 1 border of 14 edges\n");
  TriangleMesh pierced = sphere_mesh(3);
  pierced.triangles.erase(pierced.triangles.begin());
  pierced.triangles.pop_back();
  EXPECT_EQ(told(pierced), "open, with 2 borders of 6 edges\n");
}

TEST(Inspect, FindsWhatIsGraveAndStopsThere) {
  EXPECT_EQ(told({}), "GRAVE the mesh has no triangles\n");
  EXPECT_EQ(told({square, {}}), "GRAVE the mesh has no triangles\n");
  EXPECT_EQ(told({square, {{0, 1, 2}, {0, 2, 4}, {-1, 2, 3}}}),
            "GRAVE 2 triangles use vertices that do not exist, the first 1\n");
  EXPECT_EQ(told({square, {{0, 1, 2}, {2, 3, 3}}}), "GRAVE 1 triangle uses a vertex twice, the first 1\n");
  for (const float bad : {std::nanf(""), INFINITY, -INFINITY}) {
    TriangleMesh mesh{square, {{0, 1, 2}, {0, 2, 3}}};
    mesh.positions[2].y = bad;
    EXPECT_EQ(told(mesh), "GRAVE 1 vertex is not finite, the first 2\n");
  }
  EXPECT_EQ(told(moved({square, {{0, 1, 2}}}, {0, 0, -2e9f})),
            "GRAVE 4 vertices lie more than 1e9 m from the origin, the first 0\n");
}

TEST(Inspect, TellsWhatIsFarAway) {
  EXPECT_TRUE(
      tells(moved(tetrahedron(), {0, 20000, 0}), "4 vertices lie more than 10 km from the origin, the first 0"));
}

TEST(Inspect, FindsFlatAndSliverTriangles) {
  EXPECT_TRUE(tells({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 3}, {0, 1, 2}}},
                    "1 triangle has no area, the first 1"));
  EXPECT_TRUE(tells({{{0, 0, 0}, {1, 0, 0}, {0.5f, 0.0005f, 0}}, {{0, 1, 2}}},
                    "1 sliver triangle, the first 0 (worst aspect 1:2000)"));
  EXPECT_FALSE(tells({{{0, 0, 0}, {1, 0, 0}, {0.5f, 0.011f, 0}}, {{0, 1, 2}}}, "sliver"));
}

TEST(Inspect, FindsWhereTheSurfaceLiesOnItself) {
  const auto folded = [](float height) {
    return TriangleMesh{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.7f, height, 0.5f}, {0, 0, 3}},
                        {{0, 1, 2}, {1, 0, 3}, {1, 4, 2}}};
  };
  EXPECT_TRUE(tells(folded(0), "1 edge folds the surface back on itself, the first 0-1"));
  EXPECT_TRUE(tells(folded(0.7f * 0.017f), "1 edge folds"));
  EXPECT_FALSE(tells(folded(0.7f * 0.018f), "folds")) << "by more than a degree";
  EXPECT_FALSE(tells(folded(-0.7f), "folds"));
  EXPECT_FALSE(tells(grid_mesh(4, 4, 1, 1), "folds")) << "flat, but not on itself";
}

TEST(Inspect, FindsWhereAMeshColliderLiesOnItself) {
  Scene scene;
  MeshCollider collider;
  collider.name = "body";
  collider.mesh = {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.7f, 0, 0.5f}, {0, 0, 2}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  scene.add(collider);
  const auto finds = [&](const std::string& part) {
    const std::vector<Finding> found = inspect(scene);
    return std::any_of(found.begin(), found.end(),
                       [&](const Finding& one) { return one.message.find(part) != std::string::npos; });
  };
  EXPECT_TRUE(finds("triangle 2: has no area"));
  scene.mesh_colliders[0].mesh.triangles.pop_back();
  EXPECT_TRUE(finds("edge 0-1: folds the surface back on itself"));
  EXPECT_FALSE(finds("no area"));
  scene.mesh_colliders[0].mesh = sphere_mesh(2);
  EXPECT_FALSE(finds("folds"));
}

TEST(Inspect, FindsWhatIsThereTwice) {
  TriangleMesh mesh{square, {{0, 1, 2}, {0, 2, 3}, {2, 0, 1}, {3, 2, 0}}};
  EXPECT_TRUE(tells(mesh, "2 triangles have the vertices of another, the first 2"));
  mesh = {square, {{0, 1, 2}, {0, 2, 3}}};
  mesh.positions.push_back({1, 0, -0.0f});
  EXPECT_TRUE(tells(mesh, "1 vertex lies at the position of another, the first 4"));
  EXPECT_TRUE(tells(mesh, "1 vertex belongs to no triangle, the first 4"));
}

TEST(Inspect, FindsEdgesThatAreNoManifold) {
  const TriangleMesh fan{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  EXPECT_TRUE(tells(fan, "1 edge has more than two triangles, the first 0-1"));
  EXPECT_FALSE(tells(fan, "piece")) << "none of the three moves by itself";
}

TEST(Inspect, CountsPiecesThatShareNoVertex) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {9, 9, 9}},
                    {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_TRUE(tells(mesh, "2 pieces that share no vertex"));
  mesh.triangles.push_back({2, 3, 6});
  EXPECT_FALSE(tells(mesh, "pieces"));
}

TEST(Inspect, FindsTrianglesThatAreTurnedOver) {
  TriangleMesh mesh = sphere_mesh(2);
  std::swap(mesh.triangles[17][0], mesh.triangles[17][1]);
  EXPECT_TRUE(tells(mesh, "3 edges join triangles that are wound differently"));
  EXPECT_EQ(inspect(mesh)[0].advice, "turn 1 triangle over, the first 17");
  const TriangleMesh band{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {0.5f, 1, 0}, {0.5f, 1, 1}},
                          {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}, {4, 1, 5}, {5, 1, 0}}};
  EXPECT_TRUE(tells(band, "wound differently"));
  EXPECT_NE(inspect(band)[0].advice.find("Moebius"), std::string::npos);
}

TEST(Inspect, FindsVerticesThatJoinInAPointAlone) {
  const TriangleMesh bow{{{0, 0, 0}, {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 4, 3}}};
  EXPECT_TRUE(tells(bow, "1 vertex joins parts of the surface in a single point, the first 0"));
  EXPECT_FALSE(tells(bow, "pieces")) << "the point holds them together";
  EXPECT_TRUE(tells(bow, "open, with 2 borders of 6 edges"));
}

TEST(Inspect, FindsWhatIsInsideOut) {
  TriangleMesh hollow = tetrahedron();
  for (auto& t : hollow.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(told(hollow), "1 closed piece is wound inside out, the first with triangle 0\n");
  EXPECT_TRUE(tells(both(tetrahedron(), moved(hollow, {5, 0, 0})),
                    "1 closed piece is wound inside out, the first with triangle 4"));
}

TEST(Inspect, FindsWhereAMeshPassesThroughItself) {
  // A needle through a square's first triangle: each of its two long sides crosses the triangle once.
  const TriangleMesh needle{{{0.7f, 0.2f, 1}, {0.7f, 0.2f, -1}, {0.7f, 0.25f, 1}}, {{0, 1, 2}}};
  const TriangleMesh mesh = both({square, {{0, 1, 2}, {0, 2, 3}}}, needle);
  EXPECT_TRUE(tells(mesh, "an edge pierces a triangle in 2 places, the first edge 4-5 and triangle 0"));
  EXPECT_FALSE(tells(both({square, {{0, 1, 2}, {0, 2, 3}}}, moved(needle, {0, 0, 1})), "passes")) << "touches it";
  EXPECT_FALSE(tells(both({square, {{0, 1, 2}, {0, 2, 3}}}, moved(needle, {0, 0, 2})), "passes")) << "ends above it";
  EXPECT_FALSE(tells(both(tetrahedron(), tetrahedron()), "passes")) << "lies in the same planes";
}

/// The number of intersections by brute force over all pairs, in extended precision.
std::size_t count_by_brute_force(const TriangleMesh& mesh, const std::vector<Edge>& edges) {
  using Vec3l = Vec3<long double>;
  const auto at = [&](int i) {
    const Vec3f& p = mesh.positions[static_cast<std::size_t>(i)];
    return Vec3l{p.x, p.y, p.z};
  };
  const auto volume = [](const Vec3l& a, const Vec3l& b, const Vec3l& c, const Vec3l& d) {
    return dot(cross(b - a, c - a), d - a);
  };
  std::size_t count = 0;
  for (const Edge& edge : edges)
    for (const auto& t : mesh.triangles) {
      const std::set<int> all = {edge.a, edge.b, t[0], t[1], t[2]};
      if (all.size() < 5) continue;
      const Vec3l p = at(edge.a), q = at(edge.b), a = at(t[0]), b = at(t[1]), c = at(t[2]);
      const long double u = volume(p, q, a, b), v = volume(p, q, b, c), w = volume(p, q, c, a);
      const bool through = (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
      const long double below = volume(a, b, c, p), above = volume(a, b, c, q);
      count += through && ((below > 0 && above < 0) || (below < 0 && above > 0));
    }
  return count;
}

TEST(SelfIntersection, CountsWhatBruteForceCounts) {
  std::mt19937 random(11);
  const auto coordinate = [&] { return static_cast<float>(random() % 2048) / 2048.0f; };
  for (int round = 0; round < 20; ++round) {
    TriangleMesh mesh;
    for (int i = 0; i < 60; ++i)
      mesh.positions.push_back({coordinate() * (round % 3 == 0 ? 10.0f : 1.0f), coordinate(), coordinate()});
    for (int i = 0; i < 40; ++i) {
      const int a = static_cast<int>(random() % 60), b = static_cast<int>(random() % 60),
                c = static_cast<int>(random() % 60);
      if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
    }
    const std::vector<Edge> edges = find_edges(mesh.triangles, 60);
    const SelfIntersections found = find_self_intersections(mesh.positions, mesh.triangles, edges);
    EXPECT_TRUE(found.complete);
    EXPECT_EQ(found.count, count_by_brute_force(mesh, edges));
    EXPECT_GT(found.count, 20u);
  }
}

TEST(SelfIntersection, GivesUpRatherThanTakeForEver) {
  const TriangleMesh mesh = sphere_mesh(4);
  const std::vector<Edge> edges = find_edges(mesh.triangles, static_cast<int>(mesh.positions.size()));
  EXPECT_FALSE(find_self_intersections(mesh.positions, mesh.triangles, edges, 1000).complete);
  EXPECT_TRUE(find_self_intersections(mesh.positions, mesh.triangles, edges).complete);
  EXPECT_TRUE(tells(grid_mesh(150, 150, 1, 1), "too large for the search for self-intersections"));
}

}  // namespace
}  // namespace pliant
