// Terrain as heights on a regular grid: triangles are found by index arithmetic, without a BVH.
#pragma once

#include <vector>

#include "collision/broad/bounds.h"
#include "geometry/triangle.h"
#include "pliant/mesh.h"

namespace pliant {

/// The closest point of the terrain.
struct GroundPoint {
  bool found = false;
  int triangle = -1;  ///< index: 2 (r (columns - 1) + c) or the next one, for the cell at row r, column c; -1: none
  Vec3f point{};
  Vec3f normal{};      ///< unit upward normal of the triangle
  float distance = 0;  ///< distance from the query point [m], >= 0
  bool above = true;   ///< true if the query point is on the side to which the normal points
};

class Heightfield {
 public:
  /// Vertex (row r, column c) lies at origin + (c cell_width, heights[r columns + c], r cell_depth), in metres. Throws
  /// an Error unless columns, rows >= 2, columns x rows heights are given and finite, and cell sizes are positive and
  /// finite.
  Heightfield(int columns, int rows, float cell_width, float cell_depth, const Vec3f& origin,
              std::vector<float> heights);

  /// Calls visit(triangle) for each triangle whose box overlaps `box`, ascending.
  template <class Visit>
  void query(const BoxBounds& box, const Visit& visit) const;

  /// Writes a triangle's corners, counter-clockwise from above. Each cell's diagonal runs from (r, c) to (r + 1, c +
  /// 1).
  void corners(int triangle, Vec3f (&to)[3]) const;

  /// Returns the closest point nearer than `limit` [m]; of equally near ones that of the first triangle.
  GroundPoint closest(const Vec3f& p, float limit) const;

  /// Finds a corner and the upward normal of the triangle vertically above or below p. Returns false if there is none.
  bool column(const Vec3f& p, Vec3f& corner, Vec3f& normal) const;

  const BoxBounds& bounds() const { return bounds_; }
  float smaller_cell() const { return width_ < depth_ ? width_ : depth_; }
  int triangle_count() const { return 2 * (columns_ - 1) * (rows_ - 1); }
  /// Returns the terrain as a triangle mesh.
  TriangleMesh mesh() const;

 private:
  struct Range {
    int first, last;  ///< first cell and one past the last
  };
  Vec3f vertex(int row, int column) const;
  static Range cells_between(float low, float high, float origin, float size, int cells);

  int columns_, rows_;
  float width_, depth_;
  Vec3f origin_;
  std::vector<float> heights_;
  BoxBounds bounds_;
};

/// Converts a mesh in grid_mesh's numbering: rows along z, evenly spaced columns along x. Throws an Error that names
/// the first misplaced vertex.
Heightfield heightfield_of(const TriangleMesh& mesh);

template <class Visit>
void Heightfield::query(const BoxBounds& box, const Visit& visit) const {
  const Range across = cells_between(box.low.x, box.high.x, origin_.x, width_, columns_ - 1);
  const Range along = cells_between(box.low.z, box.high.z, origin_.z, depth_, rows_ - 1);
  for (int r = along.first; r < along.last; ++r)
    for (int c = across.first; c < across.last; ++c)
      for (int half = 0; half < 2; ++half) {
        const int triangle = 2 * (r * (columns_ - 1) + c) + half;
        Vec3f t[3];
        corners(triangle, t);
        if (overlap(BoxBounds::of(t, 3), box)) visit(triangle);
      }
}

}  // namespace pliant
