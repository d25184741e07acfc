// Exact geometric queries on meshes: intersections, distances, and times of contact of moving primitives. Use them to
// verify runs, or in tools of your own.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/vec3.h"

namespace pliant {

/// An edge that intersects a triangle, and has no vertex in common with it.
struct Crossing {
  int a = -1, b = -1;  ///< vertices of the edge, a < b
  int triangle = -1;

  friend bool operator==(const Crossing& x, const Crossing& y) {
    return x.a == y.a && x.b == y.b && x.triangle == y.triangle;
  }
};

/// Finds a mesh's intersections at changing positions without new allocations. Signs are exact: rounding changes
/// nothing.
class CrossingFinder {
 public:
  /// Throws an Error if a triangle has a corner outside 0..vertex_count - 1.
  CrossingFinder(const std::vector<std::array<int, 3>>& triangles, int vertex_count);
  ~CrossingFinder();
  CrossingFinder(CrossingFinder&&) noexcept;
  CrossingFinder& operator=(CrossingFinder&&) noexcept;

  /// Finds all intersections at these positions (finite, one per vertex [m]), ascending by (a, b, triangle). With
  /// `touching`, edges that only touch a triangle count too. The result is valid until the next call.
  const std::vector<Crossing>& find(const std::vector<Vec3f>& positions, bool touching = false);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

/// Finds all intersections of a mesh. Throws an Error as CrossingFinder does.
std::vector<Crossing> find_crossings(const TriangleMesh& mesh, bool touching = false);

/// The least distance of a vertex and a triangle, or of two edges, that have no vertex in common [m]; at most
/// `reach`.
double least_distance(const TriangleMesh& mesh, double reach);

/// The least distance of two segments, given by their ends (a0, a1, b0, b1) [m].
double segment_distance(const std::array<Vec3d, 4>& ends);

/// The time at which a vertex (0) and a triangle (1, 2, 3) that move linearly first come within a distance, as a share
/// of the motion in [0, 1]; empty if they do not. It is never after the true time. For distance 0 the answer in double
/// precision is exact; the one in float misses no contact, but can report a false one.
std::optional<double> vertex_triangle_impact(const std::array<Vec3d, 4>& from, const std::array<Vec3d, 4>& to,
                                             double within);
std::optional<float> vertex_triangle_impact(const std::array<Vec3f, 4>& from, const std::array<Vec3f, 4>& to,
                                            float within);

/// The time at which the edges (0, 1) and (2, 3) first come within a distance, as in vertex_triangle_impact.
std::optional<double> edge_edge_impact(const std::array<Vec3d, 4>& from, const std::array<Vec3d, 4>& to, double within);
std::optional<float> edge_edge_impact(const std::array<Vec3f, 4>& from, const std::array<Vec3f, 4>& to, float within);

}  // namespace pliant
