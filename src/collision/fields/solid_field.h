// Solids that particles meet through a distance alone: grids measured from a closed mesh, and ground given by heights. What they
// cost does not depend on the mesh that they stand for.
//
// Unlike the primitive shapes they are not convex, so a path is looked at in steps: a grid's as long as its distance allows, since
// that grows along no axis faster than one; ground in strides of half a cell.
#pragma once

#include <optional>

#include "collision/fields/distance_grid.h"
#include "collision/fields/heightfield.h"

namespace pliant {

class SolidField {
 public:
  explicit SolidField(DistanceGrid grid) : grid_(std::move(grid)) {}
  explicit SolidField(Heightfield heights);

  /// Negative inside. Of ground: to the plane of the triangle above or below, or to its underside, whichever is closer to a p between
  /// the two; far away where there is no triangle.
  SurfaceDistance<float> distance(const Vec3f& p) const;

  /// Where the straight way from a to b first comes within `margin`, within a thousandth of a stride; what is thinner than a
  /// stride may be missed.
  FirstHit<float> first_hit(const Vec3f& a, const Vec3f& b, float margin) const;

  bool is_ground() const { return heights_.has_value(); }

  /// Holds what is solid. Ground is as deep below its lowest point as it is wide, with a level underside: what is solid must not
  /// depend on who asks, and these are the bounds by which whole tiles are left out.
  BoxBounds bounds() const;

 private:
  bool is_above(const Vec3f& p, float margin) const { return heights_ && p.y > heights_->bounds().high.y + margin; }
  bool is_below(const Vec3f& p, float margin) const { return heights_ && p.y < underside_ - margin; }

  std::optional<DistanceGrid> grid_;
  std::optional<Heightfield> heights_;
  float underside_ = 0;  ///< of the ground, along y [m]
};

}  // namespace pliant
