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
  int triangle = -1;  ///< 2 (r (columns - 1) + c) and the next belong to cell (r, c)
  Vec3f point{};
  Vec3f normal{};      ///< of the triangle, unit, upward
  float distance = 0;  ///< [m], >= 0
  bool above = true;   ///< true if the query point is on the normal's side
};

class Heightfield {
 public:
  /// Vertex (row r, column c) lies at origin + (c cell_width, heights[r columns + c], r cell_depth), in metres. Throws an
  /// Error unless columns, rows >= 2, columns x rows heights are given and finite, and cell sizes are positive and finite.
  Heightfield(int columns, int rows, float cell_width, float cell_depth, const Vec3f& origin, std::vector<float> heights);

  /// Calls visit(triangle) for each triangle whose box overlaps `box`, ascending.
  template <class Visit>
  void query(const BoxBounds& box, const Visit& visit) const;

  /// The corners of a triangle, counter-clockwise from above; each cell's diagonal runs from (r, c) to (r + 1, c + 1).
  void corners(int triangle, Vec3f (&to)[3]) const;

  /// The closest point nearer than `limit` [m], the first triangle's if equal. Tests all cells within the limit.
  GroundPoint closest(const Vec3f& p, float limit) const;

  /// Finds the triangle vertically above or below p: one of its corners and its upward normal; false if there is none.
  bool column(const Vec3f& p, Vec3f& corner, Vec3f& normal) const;

  const BoxBounds& bounds() const { return bounds_; }
  float smaller_cell() const { return width_ < depth_ ? width_ : depth_; }
  int triangle_count() const { return 2 * (columns_ - 1) * (rows_ - 1); }
  /// The same terrain as a mesh.
  TriangleMesh mesh() const;

 private:
  struct Range {
    int first, last;  ///< one past the end
  };
  Vec3f vertex(int row, int column) const;
  static Range cells_between(float low, float high, float origin, float size, int cells);

  int columns_, rows_;
  float width_, depth_;
  Vec3f origin_;
  std::vector<float> heights_;
  BoxBounds bounds_;
};

/// The heightfield of a mesh in grid_mesh's numbering: rows along z, evenly
/// spaced columns along x. Throws an Error that names the first misplaced vertex.
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
