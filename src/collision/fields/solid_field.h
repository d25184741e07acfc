// Solids for contact with particles that are given by a distance function: signed distance grids and heightfields. A
// query costs the same whatever mesh they were made of.
//
// These solids are not convex, so a path is sampled in steps. In a grid the step length follows the distance, which
// grows by at most one along each axis (conservative advancement). Over terrain the step length is half a cell.
#pragma once

#include <optional>

#include "collision/fields/distance_grid.h"
#include "collision/fields/heightfield.h"

namespace pliant {

class SolidField {
 public:
  explicit SolidField(DistanceGrid grid) : grid_(std::move(grid)) {}
  explicit SolidField(Heightfield heights);

  /// Signed distance at p, negative inside [m]. For terrain it is the distance to the plane of the triangle above or
  /// below p, or to the underside if p lies between both and the underside is closer; far_away beside the terrain.
  SurfaceDistance<float> distance(const Vec3f& p) const;

  /// The first point of the segment a-b that comes within `margin` of the solid, to a thousandth of a step. Features
  /// thinner than a step can be missed.
  FirstHit<float> first_hit(const Vec3f& a, const Vec3f& b, float margin) const;

  bool is_ground() const { return heights_.has_value(); }

  /// A box that encloses the solid. Terrain extends below its lowest point by its own width, down to a level underside.
  /// That depth is fixed: whole tiles are culled by this box, so the solid must not depend on the query.
  BoxBounds bounds() const;

 private:
  bool is_above(const Vec3f& p, float margin) const { return heights_ && p.y > heights_->bounds().high.y + margin; }
  bool is_below(const Vec3f& p, float margin) const { return heights_ && p.y < underside_ - margin; }

  std::optional<DistanceGrid> grid_;
  std::optional<Heightfield> heights_;
  float underside_ = 0;  ///< underside of the terrain along y [m]
};

}  // namespace pliant
