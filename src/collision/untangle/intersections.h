// Exact intersections of surfaces with themselves and each other: the audit of contact and filter.
#pragma once

#include <vector>

#include "collision/broad/tree.h"
#include "geometry/exact.h"
#include "topology/edges.h"

namespace pliant {

/// An edge that meets a triangle without a common vertex.
struct Intersection {
  int a = -1, b = -1;  ///< the edge's ends, a < b
  int triangle = -1;
  EdgeTriangle kind = EdgeTriangle::apart;

  friend bool operator==(const Intersection& x, const Intersection& y) {
    return x.a == y.a && x.b == y.b && x.triangle == y.triangle && x.kind == y.kind;
  }
};

/// Finds intersections of one mesh over many frames without new allocations. Two triangles intersect exactly if an edge of
/// one meets the other, or, if they share a vertex, if neighbouring pairs do (docs/internals/broadphase.md).
class IntersectionFinder {
 public:
  /// Throws an Error if a triangle has a corner outside 0..vertex_count - 1.
  IntersectionFinder(const std::vector<Triangle>& triangles, int vertex_count);

  /// All pairs that cross transversally or, on request, touch; ascending by (a, b, triangle). `positions` must be finite.
  const std::vector<Intersection>& find(const std::vector<Vec3f>& positions, bool touching = false);

 private:
  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_;
  std::vector<BoxBounds> boxes_;
  Tree<BoxBounds> tree_;
  std::vector<Intersection> found_;
};

}  // namespace pliant
