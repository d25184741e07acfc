// Tests exact queries: answers must not depend on how a mesh is stored, and no impact may be missed.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>

#include "generators.h"
#include "pliant/queries.h"

namespace pliant::properties {
namespace {

using Corners = std::array<int, 3>;

/// Crossings as (edge, the triangle's sorted corners), each once.
std::set<std::pair<std::pair<int, int>, Corners>> as_set(const TriangleMesh& mesh, const std::vector<int>& name) {
  std::set<std::pair<std::pair<int, int>, Corners>> all;
  for (const Crossing& crossing : find_crossings(mesh)) {
    Corners corners = mesh.triangles[static_cast<std::size_t>(crossing.triangle)];
    for (int& corner : corners) corner = name[static_cast<std::size_t>(corner)];
    std::sort(corners.begin(), corners.end());
    all.insert({std::minmax(name[crossing.a], name[crossing.b]), corners});
  }
  return all;
}

RC_GTEST_PROP(Crossings, DoNotDependOnTheNumberingOfTheMesh, ()) {
  const int vertices = *rc::gen::inRange(4, 24);
  const TriangleMesh mesh = soup(vertices, *rc::gen::inRange(1, 30), 1);
  std::vector<int> identity, order;
  for (int i = 0; i < vertices; ++i) identity.push_back(i);
  order = identity;
  for (int i = vertices - 1; i > 0; --i)
    std::swap(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(*rc::gen::inRange(0, i + 1))]);
  TriangleMesh other;
  std::vector<int> new_number(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    new_number[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
    other.positions.push_back(mesh.positions[static_cast<std::size_t>(order[i])]);
  }
  for (auto it = mesh.triangles.rbegin(); it != mesh.triangles.rend(); ++it)
    other.triangles.push_back({new_number[(*it)[1]], new_number[(*it)[2]], new_number[(*it)[0]]});
  RC_ASSERT(as_set(mesh, identity) == as_set(other, order));
}

RC_GTEST_PROP(Crossings, StayWhenAxesAreExchanged, ()) {
  TriangleMesh mesh = soup(12, *rc::gen::inRange(1, 20), 1);
  const std::vector<Crossing> before = find_crossings(mesh);
  for (Vec3f& x : mesh.positions) x = {x.z, -x.x, x.y};
  RC_ASSERT(find_crossings(mesh) == before);
}

std::array<Vec3d, 4> in_double(const std::array<Vec3f, 4>& points) {
  std::array<Vec3d, 4> out;
  for (std::size_t i = 0; i < 4; ++i) out[i] = {double(points[i].x), double(points[i].y), double(points[i].z)};
  return out;
}

RC_GTEST_PROP(Impacts, InFloatMissNoneThatExactSignsFind, ()) {
  std::array<Vec3f, 4> from, to;
  for (Vec3f& x : from) x = point(1);
  for (Vec3f& x : to) x = point(1);
  const auto a = in_double(from), b = in_double(to);
  const auto exact = vertex_triangle_impact(a, b, 0.0), edges = edge_edge_impact(a, b, 0.0);
  const auto rounded = vertex_triangle_impact(from, to, 0.f), rounded_edges = edge_edge_impact(from, to, 0.f);
  RC_CLASSIFY(exact.has_value() || edges.has_value());
  RC_ASSERT(!exact || rounded);
  RC_ASSERT(!edges || rounded_edges);
  if (exact) RC_ASSERT(*exact >= 0 && *exact <= 1);
}

RC_GTEST_PROP(Impacts, WithinALargerDistanceComeNoLater, ()) {
  std::array<Vec3f, 4> from, to;
  for (Vec3f& x : from) x = point(1);
  for (Vec3f& x : to) x = point(1);
  const auto a = in_double(from), b = in_double(to);
  const double near = static_cast<double>(*between(0, 0.1f)), far = near + static_cast<double>(*between(0, 0.1f));
  const auto late = vertex_triangle_impact(a, b, near), early = vertex_triangle_impact(a, b, far);
  RC_ASSERT(!late || (early && *early <= *late + 1e-9));
}

}  // namespace
}  // namespace pliant::properties
