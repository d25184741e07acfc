// Exact intersections of surfaces with themselves and each other. Tests also use them to check contact and filter.
#pragma once

#include <vector>

#include "collision/broad/tree.h"
#include "geometry/exact.h"
#include "topology/edges.h"

namespace pliant {

/// An edge that intersects a triangle and has no common vertex with it.
struct Intersection {
  int a = -1, b = -1;  ///< vertices of the edge, a < b
  int triangle = -1;
  EdgeTriangle kind = EdgeTriangle::apart;

  friend bool operator==(const Intersection& x, const Intersection& y) {
    return x.a == y.a && x.b == y.b && x.triangle == y.triangle && x.kind == y.kind;
  }
};

/// Finds intersections of one mesh at changing positions without new allocations. Two triangles intersect if an edge of
/// one meets the other, or, if they share a vertex, if pairs next to them do (docs/internals/broadphase.md).
class IntersectionFinder {
 public:
  /// Throws an Error if a triangle has a corner outside 0..vertex_count - 1.
  IntersectionFinder(const std::vector<Triangle>& triangles, int vertex_count);

  /// Finds all pairs that cross or, if `touching`, touch; ascending by (a, b, triangle). `positions` must be finite.
  const std::vector<Intersection>& find(const std::vector<Vec3f>& positions, bool touching = false);

 private:
  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_;
  std::vector<BoxBounds> boxes_;
  Tree<BoxBounds> tree_;
  std::vector<Intersection> found_;
};

}  // namespace pliant
