// A triangle mesh as rigid bodies touch it: its triangles, and at each side and corner what continues the surface
// there.
//
// Bodies that slide over a mesh must not catch on inner edges. A direction of contact at an edge or a corner is
// therefore valid only in the normal cone there: the directions that point away from every triangle that has the edge
// or corner.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "collision/broad/tree.h"
#include "math/vector.h"
#include "topology/edges.h"

namespace pliant {

/// A side of a triangle. Side k lies between corners k and k + 1 (mod 3).
struct MeshSide {
  bool is_inner = false;  ///< exactly one other triangle continues the surface
  Vec3d outward{};        ///< unit vector in the triangle's plane, away from it
  Vec3d into{};     ///< of inner sides: unit vector in the other triangle's plane, from the side into that triangle
  Vec3d across{};   ///< of inner sides: unit normal of the plane that halves the angle between both triangles
  double fold = 0;  ///< of inner sides: into . normal; negative where the surface is convex as seen along the normal

  /// True if the surface bends away here from what is on the side of the normal, or of its opposite if flipped, or
  /// ends.
  bool is_convex(bool is_flipped) const { return !is_inner || (is_flipped ? fold > flat : fold < -flat); }
  static constexpr double flat = 2e-3;  ///< sine of the angle below which a fold is none
  /// A point this far beyond an inner side is over both triangles, so that it does not fall between them [m].
  static constexpr double tolerance = 1e-6;
};

struct MeshFace {
  std::array<Vec3d, 3> corners{};  ///< [m]
  Vec3d normal{};                  ///< unit normal by winding; zero if the triangle has no area
  std::array<MeshSide, 3> sides{};
  /// True if no edge at a side or a corner is convex, as seen along the normal and against it: only the triangle's own
  /// normal is a direction of contact then.
  std::array<bool, 2> is_smooth{};

  /// How far a point is beyond a side, as seen along the normal, or against it if flipped [m]. Below a valley the
  /// normals of both triangles diverge, so there the plane between them decides and no point lies beyond both.
  double beyond(std::size_t side, const Vec3d& point, bool is_flipped) const {
    const MeshSide& at = sides[side];
    const bool is_valley = at.is_inner && (is_flipped ? at.fold < 0 : at.fold > 0);
    return dot(is_valley ? at.across : at.outward, point - corners[side]);
  }
};

/// A mesh in its own frame.
class BodyMesh {
 public:
  enum class Kind {
    surface,  ///< bodies touch both sides of its triangles
    terrain   ///< solid below; triangles face upward and do not overlap as seen from above
  };

  /// Positions [m] must be finite and below 1e15, indices in range (require_indices). Vertices at the same place are
  /// one, so the surface goes on at seams of normals or texture. Thickness is added on both sides [m].
  BodyMesh(const std::vector<Vec3f>& positions, std::vector<Triangle> triangles, Kind kind = Kind::surface,
           float thickness = 0);

  /// Moves the vertices, whose number stays the same.
  void move(const std::vector<Vec3f>& positions);

  const MeshFace& face(int triangle) const { return faces_[static_cast<std::size_t>(triangle)]; }
  int triangle_count() const { return static_cast<int>(faces_.size()); }
  double thickness() const { return thickness_; }
  bool is_terrain() const { return kind_ == Kind::terrain; }
  /// A box that encloses all that bodies can touch, without thickness; terrain extends below its surface by its width.
  BoxBounds bounds() const;

  /// Writes the triangles whose boxes overlap `box`, ascending.
  void find(const BoxBounds& box, std::vector<int>& found) const;

  /// The triangle of terrain vertically above or below a point; -1 if there is none.
  int triangle_in_column(const Vec3d& point) const;

  /// True if a direction points away from all edges at a corner of a triangle, up to about 0.06 degrees.
  bool is_normal_at_corner(int triangle, int corner, const Vec3d& direction) const;
  /// True if a direction, perpendicular to a side, points away from all triangles at it, up to about 0.06 degrees.
  bool is_normal_at_side(int triangle, int side, const Vec3d& direction) const;

 private:
  void find_neighbours();
  void mark_smooth();
  MeshSide side(std::size_t triangle, std::size_t k) const;

  std::vector<Triangle> triangles_;
  std::vector<MeshFace> faces_;
  std::vector<Vec3d> positions_;
  std::vector<std::array<int, 3>> beyond_;  ///< the other triangle at each side; -1: none, or more than one
  std::vector<int> first_around_, around_;  ///< vertices that share an edge with vertex v, from first_around_[v]
  std::vector<BoxBounds> boxes_;
  Tree<BoxBounds> tree_;
  Kind kind_ = Kind::surface;
  double thickness_ = 0;
};

}  // namespace pliant
