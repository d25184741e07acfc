#include "pliant/queries.h"

#include <algorithm>
#include <cmath>

#include "collision/untangle/intersections.h"
#include "geometry/continuous.h"

namespace pliant {

struct CrossingFinder::Implementation {
  IntersectionFinder finder;
  std::vector<Crossing> found;
};

CrossingFinder::CrossingFinder(const std::vector<std::array<int, 3>>& triangles, int vertex_count)
    : self_(new Implementation{IntersectionFinder(triangles, vertex_count), {}}) {}
CrossingFinder::~CrossingFinder() = default;
CrossingFinder::CrossingFinder(CrossingFinder&&) noexcept = default;
CrossingFinder& CrossingFinder::operator=(CrossingFinder&&) noexcept = default;

const std::vector<Crossing>& CrossingFinder::find(const std::vector<Vec3f>& positions, bool touching) {
  self_->found.clear();
  for (const Intersection& i : self_->finder.find(positions, touching)) self_->found.push_back({i.a, i.b, i.triangle});
  return self_->found;
}

std::vector<Crossing> find_crossings(const TriangleMesh& mesh, bool touching) {
  return CrossingFinder(mesh.triangles, static_cast<int>(mesh.positions.size())).find(mesh.positions, touching);
}

namespace {

using Corners = std::array<Vec3d, 3>;

double vertex_distance(const Vec3d& p, const Corners& t) {
  return closest_on_triangle(p, t[0], t[1], t[2]).distance_squared;
}

/// The squared distance of two triangles: the least of their vertex-triangle and edge-edge pairs without a common
/// vertex [m^2].
double triangle_distance(const Triangle& s, const Corners& p, const Triangle& t, const Corners& q, double least) {
  const auto shares = [](int vertex, const Triangle& of) {
    return std::find(of.begin(), of.end(), vertex) != of.end();
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (!shares(s[i], t)) least = std::min(least, vertex_distance(p[i], q));
    if (!shares(t[i], s)) least = std::min(least, vertex_distance(q[i], p));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t j = (i + 1) % 3, l = (k + 1) % 3;
      if (s[i] == t[k] || s[i] == t[l] || s[j] == t[k] || s[j] == t[l]) continue;
      const Vec3d first[2] = {p[i], p[j]}, second[2] = {q[k], q[l]};
      least = std::min(least, closest_on_segments(first, second).distance_squared);
    }
  }
  return least;
}

}  // namespace

double least_distance(const TriangleMesh& mesh, double reach) {
  std::vector<Corners> corners;
  std::vector<BoxBounds> boxes;
  for (const Triangle& t : mesh.triangles) {
    Vec3f at[3];
    for (std::size_t k = 0; k < 3; ++k) at[k] = mesh.positions[static_cast<std::size_t>(t[k])];
    corners.push_back({convert<double>(at[0]), convert<double>(at[1]), convert<double>(at[2])});
    boxes.push_back(BoxBounds::of(at, 3).grown(static_cast<float>(reach)));
  }
  Tree<BoxBounds> tree;
  tree.build(boxes);
  double least = reach * reach;
  tree.self_pairs([&](int a, int b) {
    const auto i = static_cast<std::size_t>(a), k = static_cast<std::size_t>(b);
    least = triangle_distance(mesh.triangles[i], corners[i], mesh.triangles[k], corners[k], least);
  });
  return std::sqrt(least);
}

double segment_distance(const std::array<Vec3d, 4>& ends) {
  const Vec3d first[2] = {ends[0], ends[1]}, second[2] = {ends[2], ends[3]};
  return std::sqrt(closest_on_segments(first, second).distance_squared);
}

namespace {

template <class R, class Test>
std::optional<R> time_of_impact(const std::array<Vec3<R>, 4>& from, const std::array<Vec3<R>, 4>& to,
                                const Test& test) {
  Vec3<R> a[4], b[4];
  std::copy(from.begin(), from.end(), a);
  std::copy(to.begin(), to.end(), b);
  const Impact<R> impact = test(a, b);
  return impact.hit ? std::optional<R>(impact.time) : std::nullopt;
}

}  // namespace

std::optional<double> vertex_triangle_impact(const std::array<Vec3d, 4>& from, const std::array<Vec3d, 4>& to,
                                             double within) {
  return time_of_impact(from, to, [&](const auto& a, const auto& b) { return vertex_triangle_impact(a, b, within); });
}

std::optional<float> vertex_triangle_impact(const std::array<Vec3f, 4>& from, const std::array<Vec3f, 4>& to,
                                            float within) {
  return time_of_impact(from, to, [&](const auto& a, const auto& b) { return vertex_triangle_impact(a, b, within); });
}

std::optional<double> edge_edge_impact(const std::array<Vec3d, 4>& from, const std::array<Vec3d, 4>& to,
                                       double within) {
  return time_of_impact(from, to, [&](const auto& a, const auto& b) { return edge_edge_impact(a, b, within); });
}

std::optional<float> edge_edge_impact(const std::array<Vec3f, 4>& from, const std::array<Vec3f, 4>& to, float within) {
  return time_of_impact(from, to, [&](const auto& a, const auto& b) { return edge_edge_impact(a, b, within); });
}

}  // namespace pliant
