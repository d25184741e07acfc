#include "collision/untangle/initial_intersections.h"

#include <algorithm>

#include "collision/proxies/triangles_around.h"

namespace pliant {

InitialIntersections::InitialIntersections(const PairModel& model)
    : model_(model), finder_(model.elements.triangles, model.elements.vertex_count) {}

void InitialIntersections::find(const Record* positions, bool forget) {
  counts_before_.clear();
  if (!forget) counts_before_.swap(counts_);
  counts_.clear();
  std::vector<Vec3f> places(model_.rest.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = {positions[i].x, positions[i].y, positions[i].z};
  found_.clear();
  for (const Intersection& found : finder_.find(places)) {
    const int a = model_.vertex_body[found.a], b = model_.vertex_body[model_.elements.triangles[found.triangle][0]];
    if (!model_.rules.meet(a, b)) continue;
    found_.push_back(found);
    ++counts_[std::minmax(a, b)];
  }
  exempt_.clear();
  const IntLists triangles_at = found_.empty() ? IntLists{} : triangles_around(model_.elements);
  for (const Intersection& found : found_) exempt(found, triangles_at);
  std::sort(exempt_.begin(), exempt_.end());
}

bool InitialIntersections::are_no_fewer(std::pair<int, int> bodies) const {
  const auto before = counts_before_.find(bodies), now = counts_.find(bodies);
  return before != counts_before_.end() && now != counts_.end() && now->second >= before->second;
}

/// Exempts all stencils formed by the edge and the triangle.
void InitialIntersections::exempt(const Intersection& found, const IntLists& triangles_at) {
  const auto exempt_corner = [&](int vertex, const Triangle& t) { exempt_.push_back({vertex, t[0], t[1], t[2], 1}); };
  const Triangle& t = model_.elements.triangles[found.triangle];
  exempt_corner(found.a, t);
  exempt_corner(found.b, t);
  const std::array<int, 2> crossing{found.a, found.b};
  for (int k = 0; k < 3; ++k) {
    const std::array<int, 2> side{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])};
    const auto &e = std::min(crossing, side), &f = std::max(crossing, side);
    exempt_.push_back({e[0], e[1], f[0], f[1], 2});
  }
  // The triangle's corners against the triangles at the edge.
  for (const int* other = triangles_at.begin(found.a); other != triangles_at.end(found.a); ++other) {
    const Triangle& o = model_.elements.triangles[*other];
    if (o[0] != found.b && o[1] != found.b && o[2] != found.b) continue;
    for (const int corner : t) exempt_corner(corner, o);
  }
}

bool InitialIntersections::hold(const PairStencil& pair) const {
  if (exempt_.empty()) return false;
  const auto& v = pair.vertex;
  return std::binary_search(exempt_.begin(), exempt_.end(),
                            std::array<std::int32_t, 5>{v[0], v[1], v[2], v[3], pair.first_side});
}

}  // namespace pliant
