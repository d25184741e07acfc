// Compares candidates with brute force over boxes and with true distances; tests threads, and frames that allocate
// nothing.
#include "reference/candidates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "geometry/triangle.h"
#include "pliant/error.h"
#include "pliant/mesh.h"
#include "support/nasty.h"

namespace pliant {
namespace {

using testing_support::random_vector;
using PairSet = std::set<std::pair<int, int>>;

struct Moving {
  std::vector<Vec3f> from, to;
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> loose_edges;
  std::vector<int> loose_vertices;
};

/// Triangles with vertices of their own or shared with the previous one, two lines of edges and two loose vertices.
Moving random_things(std::mt19937_64& random, int kind) {
  Moving m;
  for (const auto& corners : testing_support::nasty_triangles(random, kind % testing_support::nasty_kinds)) {
    const int first = static_cast<int>(m.from.size());
    m.from.insert(m.from.end(), corners.begin(), corners.end());
    m.triangles.push_back({first, first + 1, first + 2});
    if (first > 0 && kind % 2 == 0) m.triangles.push_back({first, first - 1, first + 1});
  }
  const Vec3f near = m.from.empty() ? Vec3f{} : m.from[0];
  for (int i = 0; i < 6; ++i) m.from.push_back(near + random_vector(random, 1));
  const int n = static_cast<int>(m.from.size());
  m.loose_edges = {{n - 6, n - 5}, {n - 4, n - 5}, {n - 4, n - 3}};
  if (n > 6) m.loose_edges.push_back({n - 3, 0});
  m.loose_vertices = {n - 1, n - 2};
  for (const Vec3f& p : m.from) m.to.push_back(p + random_vector(random, kind % 3 == 0 ? 0 : 0.3f));
  return m;
}

CandidateFinder finder_of(const Moving& m) {
  return CandidateFinder(
      make_contact_elements(m.triangles, m.loose_edges, m.loose_vertices, static_cast<int>(m.from.size())));
}

PairSet as_set(const IntLists& lists) {
  PairSet pairs;
  for (int i = 0; i + 1 < static_cast<int>(lists.start.size()); ++i) {
    for (const int* item = lists.begin(i); item != lists.end(i); ++item) {
      EXPECT_TRUE(item == lists.begin(i) || item[-1] < item[0]) << "sorted, none twice";
      pairs.emplace(i, *item);
    }
  }
  return pairs;
}

BoxBounds box_of(const Moving& m, std::initializer_list<int> vertices, float radius) {
  std::vector<BoxBounds> boxes;
  for (const int v : vertices) {
    const Vec3f path[2] = {m.from[static_cast<std::size_t>(v)], m.to[static_cast<std::size_t>(v)]};
    boxes.push_back(BoxBounds::of(path, 2).grown(radius / 2));
  }
  return BoxBounds::merged(boxes.data(), static_cast<int>(boxes.size()));
}

TEST(Candidates, AreExactlyTheBoxesThatOverlapAndShareNoVertex) {
  std::mt19937_64 random(61);
  Executor executor(1);
  std::size_t total = 0;
  for (int i = 0; i < 1800; ++i) {
    const Moving m = random_things(random, i);
    const float radius = i % 2 == 0 ? 0.02f : 0.2f;
    CandidateFinder finder = finder_of(m);
    finder.find(executor, m.from, m.to, radius);
    PairSet vertex_triangles, edge_edges;
    std::set<int> vertices(m.loose_vertices.begin(), m.loose_vertices.end());
    for (const auto& t : m.triangles) vertices.insert(t.begin(), t.end());
    for (const auto& e : m.loose_edges) vertices.insert(e.begin(), e.end());
    for (const int v : vertices)
      for (std::size_t t = 0; t < m.triangles.size(); ++t) {
        const auto [a, b, c] = m.triangles[t];
        if (v != a && v != b && v != c && overlap(box_of(m, {v}, radius), box_of(m, {a, b, c}, radius)))
          vertex_triangles.emplace(v, static_cast<int>(t));
      }
    const auto& edges = finder.elements().edges;
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (std::size_t f = e + 1; f < edges.size(); ++f) {
        const auto [a, b] = edges[e];
        const auto [c, d] = edges[f];
        if (a != c && a != d && b != c && b != d && overlap(box_of(m, {a, b}, radius), box_of(m, {c, d}, radius)))
          edge_edges.emplace(static_cast<int>(e), static_cast<int>(f));
      }
    ASSERT_EQ(as_set(finder.vertex_triangles()), vertex_triangles) << i;
    ASSERT_EQ(as_set(finder.edge_edges()), edge_edges) << i;
    total += vertex_triangles.size() + edge_edges.size();
  }
  EXPECT_GT(total, 100000u);
}

TEST(Candidates, HoldEveryPairThatComesWithinTheRadius) {
  std::mt19937_64 random(62);
  Executor executor(1);
  int close = 0;
  for (int i = 0; i < 150; ++i) {
    const Moving m = random_things(random, i);
    const double radius = 0.1;
    CandidateFinder finder = finder_of(m);
    finder.find(executor, m.from, m.to, static_cast<float>(radius));
    const PairSet found = as_set(finder.vertex_triangles());
    for (std::size_t v = 0; v < m.from.size(); ++v)
      for (std::size_t t = 0; t < m.triangles.size(); ++t) {
        const auto& corners = m.triangles[t];
        if (std::find(corners.begin(), corners.end(), static_cast<int>(v)) != corners.end()) continue;
        for (int k = 0; k <= 10; ++k) {
          const auto at = [&](int vertex) {
            const Vec3d a = convert<double>(m.from[static_cast<std::size_t>(vertex)]);
            return a + (convert<double>(m.to[static_cast<std::size_t>(vertex)]) - a) * (k / 10.0);
          };
          const auto nearest =
              closest_on_triangle(at(static_cast<int>(v)), at(corners[0]), at(corners[1]), at(corners[2]));
          if (std::sqrt(nearest.distance_squared) > radius) continue;
          ++close;
          ASSERT_TRUE(found.count({static_cast<int>(v), static_cast<int>(t)})) << i;
        }
      }
  }
  EXPECT_GT(close, 3000);
}

/// Two sheets, one on the other, that move through each other and crumple a little.
std::pair<std::vector<Vec3f>, std::vector<Vec3f>> sheets_at(const TriangleMesh& sheet, int frame) {
  std::mt19937_64 random(static_cast<unsigned>(frame));
  std::vector<Vec3f> from;
  for (int copy = 0; copy < 2; ++copy)
    for (const Vec3f& p : sheet.positions)
      from.push_back(p + Vec3f{0, 0.01f * static_cast<float>(copy), 0} + random_vector(random, 0.002f));
  std::vector<Vec3f> to = from;
  for (Vec3f& p : to) p = p + random_vector(random, 0.01f);
  return {from, to};
}

TEST(Candidates, AreTheSameOnAnyThreadsAndTakeNoNewMemory) {
  const TriangleMesh sheet = grid_mesh(40, 40, 1, 1);
  Moving m;
  m.triangles = sheet.triangles;
  for (const auto& t : sheet.triangles) m.triangles.push_back({t[0] + 1600, t[1] + 1600, t[2] + 1600});
  std::tie(m.from, m.to) = sheets_at(sheet, 0);
  Executor one(1), four(4);
  CandidateFinder first = finder_of(m), second = finder_of(m), fresh = finder_of(m);
  const int* items = nullptr;
  std::size_t largest = 0;
  for (int frame = 0; frame < 6; ++frame) {
    const auto [from, to] = sheets_at(sheet, frame % 3);
    first.find(one, from, to, 0.01f);
    second.find(four, from, to, 0.01f);
    fresh.find(four, from, to, 0.01f, true);
    for (const auto lists : {&CandidateFinder::vertex_triangles, &CandidateFinder::edge_edges}) {
      ASSERT_EQ((first.*lists)().items, (second.*lists)().items);
      ASSERT_EQ((first.*lists)().start, (second.*lists)().start);
      ASSERT_EQ((first.*lists)().items, (fresh.*lists)().items);
    }
    ASSERT_GT(first.vertex_triangles().items.size(), 10000u);
    largest = std::max(largest, first.vertex_triangles().items.size());
    if (frame == 2) items = first.vertex_triangles().items.data();
    if (frame > 2) {
      EXPECT_EQ(first.vertex_triangles().items.data(), items) << "moved to new memory";
    }
  }
  EXPECT_EQ(first.vertex_triangles().items.capacity() >= largest, true);
}

TEST(Candidates, OfNothingAreNoneAndIndicesAreChecked) {
  Executor executor(1);
  CandidateFinder finder(make_contact_elements({}, {}, {}, 0));
  finder.find(executor, {}, {}, 1);
  EXPECT_TRUE(finder.vertex_triangles().items.empty());
  EXPECT_THROW(make_contact_elements({{0, 1, 3}}, {}, {}, 3), Error);
  EXPECT_THROW(make_contact_elements({}, {{0, 3}}, {}, 3), Error);
  EXPECT_THROW(make_contact_elements({}, {}, {-1}, 3), Error);
}

}  // namespace
}  // namespace pliant
