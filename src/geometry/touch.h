// Up to four points at which two convex solids touch.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/convex_shape.h"

namespace pliant {

/// One point of contact.
struct TouchPoint {
  Vec3d on_a{}, on_b{};   ///< places on the surfaces [m]; on_b - on_a is separation x normal
  double separation = 0;  ///< negative inside [m]
  /// What makes the point, the same as long as the same corners and edges do.
  std::uint32_t feature = 0;
};

struct Touch {
  Vec3d normal{};  ///< unit vector from a to b
  int count = 0;
  std::array<TouchPoint, 4> points{};
};

/// The points at which a flat feature of one solid, cut off by the sides of a polygon of the other (Sutherland and
/// Hodgman
/// 1974), is within `margin` of the polygon's plane along the normal [m]. `normal` points from a to b. The polygon belongs to
/// a, or to b if `swapped`.
std::vector<TouchPoint> points_over(const Feature& polygon, const Feature& other, const Vec3d& normal, bool swapped,
                                    double margin);

/// Chooses four points that span much of the area: the deepest, the one farthest from it, then those that are farthest
/// to both sides of the line through these.
Touch four_of(const std::vector<TouchPoint>& points, const Vec3d& normal);

}  // namespace pliant
