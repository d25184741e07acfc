// Exact geometric queries on meshes: intersections, distances, and contact times
// of moving primitives. They serve to audit runs and can be used by any tool.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/vec3.h"

namespace pliant {

/// An edge that intersects a triangle with which it shares no vertex.
struct Crossing {
  int a = -1, b = -1;  ///< the edge's ends, a < b
  int triangle = -1;

  friend bool operator==(const Crossing& x, const Crossing& y) {
    return x.a == y.a && x.b == y.b && x.triangle == y.triangle;
  }
};

/// Finds the intersections of a mesh over many frames without new allocations. Signs are exact: rounding changes no answer.
class CrossingFinder {
 public:
  /// Throws an Error if a triangle has a corner outside 0..vertex_count - 1.
  CrossingFinder(const std::vector<std::array<int, 3>>& triangles, int vertex_count);
  ~CrossingFinder();
  CrossingFinder(CrossingFinder&&) noexcept;
  CrossingFinder& operator=(CrossingFinder&&) noexcept;

  /// All intersections at these positions (finite, one per vertex [m]), ascending by (a, b, triangle). `touching` includes
  /// edges that only touch a triangle. Valid until the next call.
  const std::vector<Crossing>& find(const std::vector<Vec3f>& positions, bool touching = false);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

/// All intersections of a mesh. Throws as CrossingFinder does.
std::vector<Crossing> find_crossings(const TriangleMesh& mesh, bool touching = false);

/// The least vertex-triangle or edge-edge distance of primitives without
/// a common vertex, if it is below `reach` [m]; otherwise `reach`.
double least_distance(const TriangleMesh& mesh, double reach);

/// The least distance of two segments, given by their ends (a0, a1, b0, b1) [m].
double segment_distance(const std::array<Vec3d, 4>& ends);

/// The time at which a vertex (0) and a triangle (1, 2, 3) under linear motion first come within a distance: a share of the
/// motion in [0, 1], never after the true time; empty if they do not. In double the answer for distance 0 is exact; in
/// float there can be false positives, but no misses.
std::optional<double> vertex_triangle_impact(const std::array<Vec3d, 4>& from, const std::array<Vec3d, 4>& to,
                                             double within);
std::optional<float> vertex_triangle_impact(const std::array<Vec3f, 4>& from, const std::array<Vec3f, 4>& to, float within);

/// The same for two edges, (0, 1) and (2, 3).
std::optional<double> edge_edge_impact(const std::array<Vec3d, 4>& from, const std::array<Vec3d, 4>& to, double within);
std::optional<float> edge_edge_impact(const std::array<Vec3f, 4>& from, const std::array<Vec3f, 4>& to, float within);

}  // namespace pliant
