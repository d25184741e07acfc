// Solids that particles meet through a distance alone: grids measured from a closed mesh, and ground given by heights. What they
// cost does not depend on the mesh that they stand for.
//
// Unlike the primitive shapes they are not convex, so a path is looked at in steps: a grid's as long as its distance allows, since
// that grows along no axis faster than one; ground in strides of half a cell.
#pragma once

#include <optional>

#include "collision/distance_grid.h"
#include "collision/heightfield.h"

namespace pliant {

class SolidField {
 public:
  explicit SolidField(DistanceGrid grid) : grid_(std::move(grid)) {}
  explicit SolidField(Heightfield heights) : heights_(std::move(heights)) {}

  /// Negative inside. Of ground: to the plane of the triangle above or below, far away where there is none.
  SurfaceDistance<float> distance(const Vec3f& p) const;

  /// Where the straight way from a to b first comes within `margin`, within a thousandth of a stride; what is thinner than a
  /// stride may be missed.
  FirstHit<float> first_hit(const Vec3f& a, const Vec3f& b, float margin) const;

  /// Holds what is solid; ground is as deep as it is wide.
  BoxBounds bounds() const;

 private:
  bool is_above(const Vec3f& p, float margin) const { return heights_ && p.y > heights_->bounds().high.y + margin; }

  std::optional<DistanceGrid> grid_;
  std::optional<Heightfield> heights_;
};

}  // namespace pliant
