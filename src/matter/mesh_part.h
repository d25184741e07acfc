// A part of a closed mesh between planes along the axes, as decompose.cpp divides it: the pieces of its triangles, and
// the nodes of a grid of distances that lie in it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/convex_hull.h"
#include "pliant/vec3.h"

namespace pliant {

/// A node of a grid, and how far it is from the mesh, negative inside [m].
struct GridNode {
  std::array<std::int32_t, 3> at{};
  float distance = 0;
};

/// Between which planes along thirteen directions points of a grid lie.
class GridSlabs {
 public:
  static constexpr int directions = 13;

  void add(const std::array<std::int32_t, 3>& at);
  bool contain(const std::array<std::int32_t, 3>& at) const;

 private:
  std::array<std::int32_t, directions> low_{}, high_{};
  bool is_empty_ = true;
};

/// The coordinate of a point along axis 0, 1 or 2.
inline float& coordinate(Vec3f& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
inline float coordinate(const Vec3f& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// A plane perpendicular to an axis.
struct AxisPlane {
  int axis = 0;
  float place = 0;        ///< [m]
  std::int32_t node = 0;  ///< the last node before it
};

struct MeshPart {
  std::vector<std::array<Vec3f, 3>> triangles;
  std::vector<GridNode> solid;  ///< in the mesh, or within less than a cell of it
  /// Outside of the mesh by more than the tolerance, but between the slabs of the others.
  std::vector<GridNode> hollow;

  /// Keeps only hollow nodes between the slabs.
  void drop_far_hollows();

  /// How bad a plane is: what the two halves would fill, as the sum of depths, and a small share of it if one half is
  /// smaller.
  double cost_of(const AxisPlane& plane) const;

  /// What lies before a plane and beyond it.
  std::array<MeshPart, 2> divided(const AxisPlane& plane) const;
};

}  // namespace pliant
