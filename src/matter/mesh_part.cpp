#include "matter/mesh_part.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace pliant {

namespace {

/// The thirteen directions between neighbours of a grid.
constexpr std::array<std::array<std::int32_t, 3>, GridSlabs::directions> grid_directions{{{1, 0, 0},
                                                                                          {0, 1, 0},
                                                                                          {0, 0, 1},
                                                                                          {0, 1, 1},
                                                                                          {0, 1, -1},
                                                                                          {1, 0, 1},
                                                                                          {1, 0, -1},
                                                                                          {1, 1, 0},
                                                                                          {1, -1, 0},
                                                                                          {1, 1, 1},
                                                                                          {1, 1, -1},
                                                                                          {1, -1, 1},
                                                                                          {1, -1, -1}}};

std::int32_t along(std::size_t way, const std::array<std::int32_t, 3>& at) {
  return grid_directions[way][0] * at[0] + grid_directions[way][1] * at[1] + grid_directions[way][2] * at[2];
}

/// Where a segment meets the plane; the same for both directions of the segment.
Vec3f crossing(Vec3f a, Vec3f b, const AxisPlane& plane) {
  if (coordinate(b, plane.axis) < coordinate(a, plane.axis)) std::swap(a, b);
  const float from = coordinate(a, plane.axis), to = coordinate(b, plane.axis);
  Vec3f p = a + (b - a) * ((plane.place - from) / (to - from));
  coordinate(p, plane.axis) = plane.place;
  return p;
}

/// Adds the part of a triangle on one side of the plane: side -1 before it, 1 beyond (Sutherland and Hodgman 1974).
void clip(const std::array<Vec3f, 3>& triangle, const AxisPlane& plane, float side,
          std::vector<std::array<Vec3f, 3>>& out) {
  const bool lies_in_plane = std::all_of(triangle.begin(), triangle.end(),
                                         [&](const Vec3f& p) { return coordinate(p, plane.axis) == plane.place; });
  if (lies_in_plane) return;  // its corners are those of triangles beside it, which know their side
  std::array<Vec3f, 4> polygon;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3f &p = triangle[i], &q = triangle[(i + 1) % 3];
    const float here = side * (coordinate(p, plane.axis) - plane.place),
                there = side * (coordinate(q, plane.axis) - plane.place);
    if (here >= 0) polygon[count++] = p;
    if ((here > 0 && there < 0) || (here < 0 && there > 0)) polygon[count++] = crossing(p, q, plane);
  }
  for (std::size_t i = 2; i < count; ++i) out.push_back({polygon[0], polygon[i - 1], polygon[i]});
}

}  // namespace

void GridSlabs::add(const std::array<std::int32_t, 3>& at) {
  for (std::size_t k = 0; k < grid_directions.size(); ++k) {
    const std::int32_t place = along(k, at);
    low_[k] = is_empty_ ? place : std::min(low_[k], place);
    high_[k] = is_empty_ ? place : std::max(high_[k], place);
  }
  is_empty_ = false;
}

bool GridSlabs::contain(const std::array<std::int32_t, 3>& at) const {
  if (is_empty_) return false;
  for (std::size_t k = 0; k < grid_directions.size(); ++k) {
    const std::int32_t place = along(k, at);
    if (place < low_[k] || place > high_[k]) return false;
  }
  return true;
}

void MeshPart::drop_far_hollows() {
  GridSlabs slabs;
  for (const GridNode& node : solid) slabs.add(node.at);
  std::erase_if(hollow, [&](const GridNode& node) { return !slabs.contain(node.at); });
}

namespace {

std::size_t side_of(const GridNode& node, const AxisPlane& plane) {
  return node.at[static_cast<std::size_t>(plane.axis)] > plane.node ? 1 : 0;
}

/// A node beside the mesh that is as near to the plane: it may belong to the other side.
bool is_doubtful(const GridNode& node, const AxisPlane& plane) {
  const std::int32_t beyond = node.at[static_cast<std::size_t>(plane.axis)] - plane.node;
  return node.distance > 0 && (beyond == 0 || beyond == 1);
}

/// Of planes after which about as much is filled, one that divides evenly is better: cutting a ring in two does not
/// help at once.
constexpr double share_of_balance = 0.1;

}  // namespace

double MeshPart::cost_of(const AxisPlane& plane) const {
  std::array<GridSlabs, 2> halves;
  std::array<double, 2> counts{};
  for (const GridNode& node : solid) {
    ++counts[side_of(node, plane)];
    if (!is_doubtful(node, plane)) halves[side_of(node, plane)].add(node.at);
  }
  double filled = 0, all = 0;
  for (const GridNode& node : hollow) {
    const auto depth = static_cast<double>(node.distance);
    all += depth;
    if (halves[side_of(node, plane)].contain(node.at)) filled += depth;
  }
  return filled + share_of_balance * all * std::abs(counts[0] - counts[1]) / (counts[0] + counts[1]);
}

std::array<MeshPart, 2> MeshPart::divided(const AxisPlane& plane) const {
  std::array<MeshPart, 2> halves;
  for (const std::array<Vec3f, 3>& triangle : triangles) {
    clip(triangle, plane, -1, halves[0].triangles);
    clip(triangle, plane, 1, halves[1].triangles);
  }
  for (const GridNode& node : solid) halves[side_of(node, plane)].solid.push_back(node);
  for (const GridNode& node : hollow) halves[side_of(node, plane)].hollow.push_back(node);
  for (MeshPart& half : halves) half.drop_far_hollows();
  return halves;
}

}  // namespace pliant
