// Where surfaces pass through themselves or one another, exactly: the audit of everything that is to prevent it.
#pragma once

#include <vector>

#include "collision/broad/tree.h"
#include "geometry/exact.h"
#include "topology/edges.h"

namespace pliant {

/// An edge that meets a triangle with which it shares no vertex.
struct Intersection {
  int a = -1, b = -1;  ///< the edge's ends, a < b
  int triangle = -1;
  EdgeTriangle kind = EdgeTriangle::apart;

  friend bool operator==(const Intersection& x, const Intersection& y) {
    return x.a == y.a && x.b == y.b && x.triangle == y.triangle && x.kind == y.kind;
  }
};

/// Finds intersections of one mesh over many frames without new memory. Two triangles that share no vertex intersect exactly
/// if an edge of one meets the other; of two that share one, so do pairs about them (docs/internals/broadphase.md).
class IntersectionFinder {
 public:
  /// Throws Error where a triangle has a corner outside 0..vertex_count - 1.
  IntersectionFinder(const std::vector<Triangle>& triangles, int vertex_count);

  /// All pairs that cross properly and, if asked for, those that touch; ascending by (a, b, triangle). `positions` finite.
  const std::vector<Intersection>& find(const std::vector<Vec3f>& positions, bool touching = false);

 private:
  std::vector<Triangle> triangles_;
  std::vector<Edge> edges_;
  std::vector<BoxBounds> boxes_;
  Tree<BoxBounds> tree_;
  std::vector<Intersection> found_;
};

}  // namespace pliant
