// Exact questions about meshes: do surfaces pass through one another, how near are they, do moving primitives meet. They judge
// what a run did, and any tool may ask them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/vec3.h"

namespace pliant {

/// An edge that passes through a triangle with which it shares no vertex.
struct Crossing {
  int a = -1, b = -1;  ///< the edge's ends, a < b
  int triangle = -1;

  friend bool operator==(const Crossing& x, const Crossing& y) {
    return x.a == y.a && x.b == y.b && x.triangle == y.triangle;
  }
};

/// Finds the crossings of one mesh over many frames without new memory. The signs are exact: rounding changes no answer.
class CrossingFinder {
 public:
  /// Throws Error where a triangle has a corner outside 0..vertex_count - 1.
  CrossingFinder(const std::vector<std::array<int, 3>>& triangles, int vertex_count);
  ~CrossingFinder();
  CrossingFinder(CrossingFinder&&) noexcept;
  CrossingFinder& operator=(CrossingFinder&&) noexcept;

  /// All crossings with these positions (finite, one a vertex [m]), ascending by (a, b, triangle); edges that only touch a
  /// triangle too where `touching`. Valid until the next call.
  const std::vector<Crossing>& find(const std::vector<Vec3f>& positions, bool touching = false);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

/// All crossings of a mesh. Throws Error as CrossingFinder does.
std::vector<Crossing> find_crossings(const TriangleMesh& mesh, bool touching = false);

/// The least distance of a vertex and a triangle, or of two edges, that share no vertex, where it is below `reach` [m]; else
/// `reach`.
double least_distance(const TriangleMesh& mesh, double reach);

/// The least distance of two segments, given by their ends (a0, a1, b0, b1) [m].
double segment_distance(const std::array<Vec3d, 4>& ends);

/// When a vertex (number 0) and a triangle (1, 2, 3), all of which move straight, first come within a distance of one another,
/// as a share of the motion in [0, 1] and never after the true time; nothing where they do not. In double the answer for
/// distance 0 is decided by exact signs; in float it may be a false alarm, and never a miss.
std::optional<double> vertex_triangle_impact(const std::array<Vec3d, 4>& from, const std::array<Vec3d, 4>& to,
                                             double within);
std::optional<float> vertex_triangle_impact(const std::array<Vec3f, 4>& from, const std::array<Vec3f, 4>& to, float within);

/// The same for two edges, (0, 1) and (2, 3).
std::optional<double> edge_edge_impact(const std::array<Vec3d, 4>& from, const std::array<Vec3d, 4>& to, double within);
std::optional<float> edge_edge_impact(const std::array<Vec3f, 4>& from, const std::array<Vec3f, 4>& to, float within);

}  // namespace pliant
