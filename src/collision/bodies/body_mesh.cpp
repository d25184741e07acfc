#include "collision/bodies/body_mesh.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

#include "math/vector.h"

namespace pliant {

namespace {

/// Sine of the angle by which a direction may leave a normal cone: well above the error of contact directions.
constexpr double cone_tolerance = 1e-3;

/// The unit vector in a triangle's plane that points away from a side to the inside; zero if there is none.
Vec3d inward(const MeshFace& face, int side) {
  const auto k = static_cast<std::size_t>(side);
  return unit_or(cross(face.normal, face.corners[(k + 1) % 3] - face.corners[k]), Vec3d{});
}

/// Lets triangles use the first of all vertices at the same place.
void join_corners(const std::vector<Vec3f>& positions, std::vector<Triangle>& triangles) {
  const auto place = [&](int v) {
    const Vec3f& p = positions[static_cast<std::size_t>(v)];
    return std::tuple{p.x, p.y, p.z};
  };
  std::vector<int> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::tuple{place(a), a} < std::tuple{place(b), b};
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_same = i > 0 && place(order[i]) == place(order[i - 1]);
    first[static_cast<std::size_t>(order[i])] = is_same ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  for (Triangle& triangle : triangles)
    for (int& corner : triangle) corner = first[static_cast<std::size_t>(corner)];
}

/// The side of a triangle between vertices a < b. A degenerate triangle may have it twice.
int side_of(const Triangle& triangle, int a, int b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax({triangle[k], triangle[(k + 1) % 3]});
    if (low == a && high == b) return static_cast<int>(k);
  }
  return -1;
}

}  // namespace

BodyMesh::BodyMesh(const std::vector<Vec3f>& positions, std::vector<Triangle> triangles, Kind kind, float thickness)
    : triangles_(std::move(triangles)), kind_(kind), thickness_(static_cast<double>(thickness)) {
  positions_.resize(positions.size());
  join_corners(positions, triangles_);
  find_neighbours();
  move(positions);
  tree_.build(boxes_);
}

void BodyMesh::find_neighbours() {
  const auto vertices = static_cast<int>(positions_.size());
  const std::vector<Edge> edges = find_edges(triangles_, vertices);
  beyond_.assign(triangles_.size(), {-1, -1, -1});
  std::vector<int> counts(positions_.size() + 1, 0);
  for (const Edge& edge : edges) {
    ++counts[static_cast<std::size_t>(edge.a)];
    ++counts[static_cast<std::size_t>(edge.b)];
    if (!edge.is_inner()) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto triangle = static_cast<std::size_t>(edge.triangles[i]);
      const int side = side_of(triangles_[triangle], edge.a, edge.b);
      if (side >= 0) beyond_[triangle][static_cast<std::size_t>(side)] = edge.triangles[1 - i];
    }
  }
  first_around_.assign(positions_.size() + 1, 0);
  for (std::size_t v = 0; v < positions_.size(); ++v) first_around_[v + 1] = first_around_[v] + counts[v];
  around_.resize(static_cast<std::size_t>(first_around_.back()));
  std::vector<int> next(first_around_.begin(), first_around_.end() - 1);
  for (const Edge& edge : edges) {
    around_[static_cast<std::size_t>(next[static_cast<std::size_t>(edge.a)]++)] = edge.b;
    around_[static_cast<std::size_t>(next[static_cast<std::size_t>(edge.b)]++)] = edge.a;
  }
}

void BodyMesh::move(const std::vector<Vec3f>& positions) {
  for (std::size_t v = 0; v < positions_.size(); ++v) positions_[v] = convert<double>(positions[v]);
  faces_.resize(triangles_.size());
  boxes_.resize(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    Vec3f corners[3];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = positions[static_cast<std::size_t>(triangles_[t][k])];
    boxes_[t] = BoxBounds::of(corners, 3);
    MeshFace& face = faces_[t];
    for (std::size_t k = 0; k < 3; ++k) face.corners[k] = convert<double>(corners[k]);
    face.normal = unit_or(cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]), Vec3d{});
  }
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) faces_[t].sides[k] = side(t, k);
  mark_smooth();
  if (tree_.leaf_count() > 0) tree_.refit(boxes_);
}

void BodyMesh::mark_smooth() {
  for (const bool is_flipped : {false, true}) {
    std::vector<char> has_edge(positions_.size(), 0);
    for (std::size_t t = 0; t < faces_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (faces_[t].sides[k].is_convex(is_flipped))
          for (const std::size_t end : {k, (k + 1) % 3}) has_edge[static_cast<std::size_t>(triangles_[t][end])] = 1;
    for (std::size_t t = 0; t < faces_.size(); ++t)
      faces_[t].is_smooth[is_flipped ? 1 : 0] = std::none_of(triangles_[t].begin(), triangles_[t].end(), [&](int v) {
        return has_edge[static_cast<std::size_t>(v)] != 0;
      });
  }
}

MeshSide BodyMesh::side(std::size_t triangle, std::size_t k) const {
  MeshSide out;
  out.outward = -inward(faces_[triangle], static_cast<int>(k));
  if (beyond_[triangle][k] < 0) return out;
  const auto other = static_cast<std::size_t>(beyond_[triangle][k]);
  const auto [a, b] = std::minmax({triangles_[triangle][k], triangles_[triangle][(k + 1) % 3]});
  out.into = inward(faces_[other], side_of(triangles_[other], a, b));
  out.is_inner = length_squared(out.into) > 0;
  out.across = unit_or(out.into + out.outward, out.outward);
  out.fold = dot(out.into, faces_[triangle].normal);
  return out;
}

BoxBounds BodyMesh::bounds() const {
  if (boxes_.empty()) return {};
  BoxBounds box = BoxBounds::merged(boxes_.data(), static_cast<int>(boxes_.size()));
  if (is_terrain()) box.low.y -= max(box.high.x - box.low.x, box.high.z - box.low.z);
  return box;
}

void BodyMesh::find(const BoxBounds& box, std::vector<int>& found) const {
  found.clear();
  tree_.query(box, [&](int triangle) { found.push_back(triangle); });
  std::sort(found.begin(), found.end());
}

int BodyMesh::triangle_in_column(const Vec3d& point) const {
  const Vec3f p = convert<float>(point);
  std::vector<int> found;
  find(BoxBounds{{p.x, -3e38f, p.z}, {p.x, 3e38f, p.z}}, found);
  for (const int triangle : found) {
    const auto& t = face(triangle).corners;
    bool is_inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d along = t[(k + 1) % 3] - t[k], away = convert<double>(p) - t[k];
      is_inside = is_inside && along.z * away.x - along.x * away.z >= 0;
    }
    if (is_inside) return triangle;
  }
  return -1;
}

bool BodyMesh::is_normal_at_corner(int triangle, int corner, const Vec3d& direction) const {
  const auto v =
      static_cast<std::size_t>(triangles_[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(corner)]);
  for (int i = first_around_[v]; i < first_around_[v + 1]; ++i) {
    const Vec3d along = positions_[static_cast<std::size_t>(around_[static_cast<std::size_t>(i)])] - positions_[v];
    const double towards = dot(direction, along);
    if (towards > 0 && towards * towards > cone_tolerance * cone_tolerance * length_squared(along)) return false;
  }
  return true;
}

bool BodyMesh::is_normal_at_side(int triangle, int side, const Vec3d& direction) const {
  const MeshFace& face = faces_[static_cast<std::size_t>(triangle)];
  const MeshSide& at = face.sides[static_cast<std::size_t>(side)];
  if (-dot(direction, at.outward) > cone_tolerance) return false;
  return !at.is_inner || dot(direction, at.into) <= cone_tolerance;
}

}  // namespace pliant
