// Closest points by a BVH; inside tests by exact crossings of a segment that ends outside the mesh's box.
#include "collision/fields/mesh_query.h"

#include "geometry/exact.h"

namespace pliant {

MeshQuery::MeshQuery(std::vector<Vec3f> positions, std::vector<Triangle> triangles)
    : positions_(std::move(positions)), triangles_(std::move(triangles)), boxes_(triangles_.size()) {
  fit();
  tree_.build(boxes_);
}

void MeshQuery::move(const std::vector<Vec3f>& positions) {
  positions_ = positions;
  fit();
  tree_.refit(boxes_);
}

void MeshQuery::fit() {
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    Vec3f corners[3];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = positions_[static_cast<std::size_t>(triangles_[t][k])];
    boxes_[t] = BoxBounds::of(corners, 3);
  }
  if (!boxes_.empty()) bounds_ = BoxBounds::merged(boxes_.data(), static_cast<int>(boxes_.size()));
}

SurfacePoint MeshQuery::closest(const Vec3f& p, float limit) const {
  const auto find = [&](int triangle) {
    const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
    const auto corner = [&](std::size_t k) { return convert<double>(positions_[static_cast<std::size_t>(t[k])]); };
    return closest_on_triangle(convert<double>(p), corner(0), corner(1), corner(2));
  };
  const auto [triangle, distance] =
      tree_.closest(p, limit, [&](int t) { return static_cast<float>(sqrt(find(t).distance_squared)); });
  if (triangle < 0) return {};
  const auto found = find(triangle);
  return {triangle, convert<float>(found.point), convert<float>(found.weights), distance};
}

namespace {

/// Returns the end of the ray for attempt number `attempt`: a point outside the box, in a direction that mesh edges are
/// rarely aligned with.
Vec3f ray_end(const Vec3f& p, const BoxBounds& box, int attempt) {
  const Vec3f size = box.high - box.low;
  const float reach = size.x + size.y + size.z + 1e-30f, turn = static_cast<float>(attempt);
  const float step = 2 * reach + (attempt % 2 == 0 ? box.high.x - p.x : p.x - box.low.x);
  return {attempt % 2 == 0 ? p.x + step : p.x - step, p.y + step * (0.0137f + 0.0713f * turn),
          p.z + step * (0.0291f - 0.0577f * turn)};
}

}  // namespace

int MeshQuery::winding_number(const Vec3f& p) const {
  if (boxes_.empty() || !overlap(BoxBounds{p, p}, bounds_)) return 0;
  constexpr int most_attempts = 16;
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    const Vec3f edge[2] = {p, ray_end(p, bounds_, attempt)};
    int winding = 0;
    bool clean = true;
    tree_.query(BoxBounds::of(edge, 2), [&](int triangle) {
      const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
      const Vec3f corners[3] = {positions_[static_cast<std::size_t>(t[0])], positions_[static_cast<std::size_t>(t[1])],
                                positions_[static_cast<std::size_t>(t[2])]};
      const EdgeTriangle meets = how_edge_meets_triangle(edge, corners);
      clean = clean && meets != EdgeTriangle::touching;
      if (meets == EdgeTriangle::crossing) winding -= volume_sign(corners[0], corners[1], corners[2], p);
    });
    if (clean) return winding;
  }
  return 0;  // the point is on the surface, where every ray is degenerate
}

}  // namespace pliant
