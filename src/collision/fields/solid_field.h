// Solids that particles meet through a distance function: signed distance grids
// and heightfields. The cost is independent of the mesh that they represent.
//
// These solids are not convex, so a path is sampled in strides. A grid's strides follow its distance, which grows by at
// most one along each axis (conservative advancement). Terrain uses strides of half a cell.
#pragma once

#include <optional>

#include "collision/fields/distance_grid.h"
#include "collision/fields/heightfield.h"

namespace pliant {

class SolidField {
 public:
  explicit SolidField(DistanceGrid grid) : grid_(std::move(grid)) {}
  explicit SolidField(Heightfield heights);

  /// Signed distance, negative inside. For terrain: to the plane of the triangle above or below, or to the underside if p
  /// lies between and that is closer; far_away outside the terrain.
  SurfaceDistance<float> distance(const Vec3f& p) const;

  /// The first point of the segment a-b within `margin`, to a thousandth
  /// of a stride. Features thinner than a stride can be missed.
  FirstHit<float> first_hit(const Vec3f& a, const Vec3f& b, float margin) const;

  bool is_ground() const { return heights_.has_value(); }

  /// Encloses the solid. Terrain extends below its lowest point by its width, with a level underside. The depth is fixed
  /// because these bounds cull whole tiles, so the solid must not depend on the query.
  BoxBounds bounds() const;

 private:
  bool is_above(const Vec3f& p, float margin) const { return heights_ && p.y > heights_->bounds().high.y + margin; }
  bool is_below(const Vec3f& p, float margin) const { return heights_ && p.y < underside_ - margin; }

  std::optional<DistanceGrid> grid_;
  std::optional<Heightfield> heights_;
  float underside_ = 0;  ///< underside of the terrain along y [m]
};

}  // namespace pliant
