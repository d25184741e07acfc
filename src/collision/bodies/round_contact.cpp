#include "collision/bodies/round_contact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/convex_contact.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// What turns under the flat part by more than this share of the angle that this covers rolls along it.
constexpr double rolling_share = 0.25;
constexpr double any_height = 1e30;  ///< [m]

/// A round solid and one with a flat part, in the frame of solid a of the contact.
struct Pair {
  const ConvexShape &round, &flat;
  Posed round_pose, flat_pose;
  Vec3d outward{};  ///< the normal from the round one to the flat one
  double steepest = 0;
  bool round_is_b = false;

  double radius() const { return radius_of(round) + static_cast<double>(flat.radius); }
  static double radius_of(const ConvexShape& shape) { return static_cast<double>(shape.radius + shape.core_radius); }
};

/// Where the flat part may touch before contacts are found again: a rectangle in the plane of contact.
struct Footprint {
  Vec3d centre{}, along{}, across{};  ///< unit vectors
  double half_along = 0, half_across = 0;

  Feature polygon(const Vec3d& normal) const {
    const Vec3d u = along * half_along, v = across * half_across;
    Feature out;
    out.count = 4;
    out.points = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
    out.normal = normal;
    return out;
  }
};

bool is_round(const ConvexShape& shape) {
  using Kind = ConvexShape::Kind;
  return shape.kind == Kind::point || shape.kind == Kind::segment || shape.kind == Kind::cylinder;
}

/// True if solid b counts as the round one.
bool b_is_round(const ConvexShape& a, const ConvexShape& b, const Rocking& rocking) {
  if (!is_round(a) || !(rocking.on_a > 0)) return true;
  return is_round(b) && rocking.on_b > 0 && Pair::radius_of(b) > Pair::radius_of(a);
}

/// Half of the extent of a feature along a unit vector.
double half_extent(const Feature& feature, const Vec3d& along) {
  double least = dot(feature.points[0], along), most = least;
  for (int i = 1; i < feature.count; ++i) {
    const double at = dot(feature.points[static_cast<std::size_t>(i)], along);
    least = std::min(least, at);
    most = std::max(most, at);
  }
  return 0.5 * (most - least);
}

Vec3d axis_of(const Pair& pair) { return rotate(pair.round_pose.rotation, Vec3d{0, 1, 0}); }

/// True if the round solid is touched at the side, and not at an end.
bool is_touched_at_side(const Pair& pair) {
  return pair.round.half_length > 0 && std::fabs(dot(axis_of(pair), pair.outward)) < pair.steepest;
}

/// True if one solid is round where they touch and the other one is dynamic.
bool may_rock(const Pair& pair) {
  if (!is_round(pair.round) || !(pair.steepest > 0) || !(pair.radius() > 0)) return false;
  return pair.round.kind != ConvexShape::Kind::cylinder || is_touched_at_side(pair);
}

/// Along the axis of a round solid that is touched at its side; else along the first edge of the flat part.
Footprint footprint_of(const Pair& pair, const Feature& flat, const Vec3d& nearest, double reach) {
  const Vec3d axis = axis_of(pair), &n = pair.outward;
  const bool has_axis = is_touched_at_side(pair);
  const Vec3d wanted = has_axis ? axis : flat.points[1] - flat.points[0];
  Footprint out;
  out.along = unit_or(wanted - n * dot(wanted, n), Vec3d{1, 0, 0});
  out.across = cross(n, out.along);
  out.centre = has_axis ? pair.round_pose.position + n * dot(n, nearest - pair.round_pose.position) : nearest;
  const double beyond = pair.round.kind == ConvexShape::Kind::cylinder ? 0 : reach;  // over the ends of a capsule
  out.half_along = beyond + (has_axis ? static_cast<double>(pair.round.half_length) : 0);
  out.half_across = reach;
  return out;
}

/// True if the flat part is so narrow that it may rock from one side to the other, and the round solid does not roll
/// along it.
bool reaches_sides(const Pair& pair, const Feature& flat, const Footprint& footprint, double turning) {
  const double across = half_extent(flat, footprint.across), along = half_extent(flat, footprint.along);
  const double half = is_touched_at_side(pair) ? across : std::min(across, along);
  return half <= footprint.half_across && turning * pair.radius() <= rolling_share * half;
}

/// The distance of a point in the frame of a round solid from its surface, for a cylinder from its side. Inside, the
/// nearest place of a cylinder's surface may be at an end, which says nothing about what lies on the side.
double distance_from(const ConvexShape& round, const Vec3d& point) {
  const bool is_cylinder = round.kind == ConvexShape::Kind::cylinder;
  const double beyond = is_cylinder ? 0 : std::max(std::fabs(point.y) - static_cast<double>(round.half_length), 0.);
  return length(Vec3d{point.x, beyond, point.z}) - Pair::radius_of(round);
}

/// Sets the separations of points whose places on the flat solid's core are known. Returns the least one.
double place(const Pair& pair, std::vector<TouchPoint>& points) {
  const double radius = static_cast<double>(pair.flat.radius);
  double lowest = any_height;
  for (TouchPoint& point : points) {
    Vec3d& on_flat = pair.round_is_b ? point.on_a : point.on_b;
    point.separation = distance_from(pair.round, to_local(pair.round_pose, on_flat)) - radius;
    on_flat -= pair.outward * radius;
    lowest = std::min(lowest, point.separation);
  }
  return lowest;
}

/// Moves all points down by `height`, and sets their places on the round solid.
void lower(const Pair& pair, double height, std::vector<TouchPoint>& points) {
  for (TouchPoint& point : points) {
    point.separation -= height;
    const Vec3d below = pair.outward * point.separation;
    if (pair.round_is_b)
      point.on_b = point.on_a - below;
    else
      point.on_a = point.on_b - below;
  }
}

const TouchPoint& nearest_of(const Touch& found) {
  return *std::min_element(found.points.begin(), found.points.begin() + found.count,
                           [](const TouchPoint& a, const TouchPoint& b) { return a.separation < b.separation; });
}

}  // namespace

Rocking rocking_of(const BodyState& a, const BodyState& b, float dt, float faster) {
  // A flat part on a dynamic solid may lie under it, too, and a ball rolls over it: little may count as flat there.
  constexpr double on_fixed = 0.2, on_dynamic = 0.1;  // [rad]
  constexpr double falls = 2;                         // times dt^2 g: so boxes have corners from omega dt = 0.7 on
  const auto angle = [](const BodyState& round, const BodyState& flat) {
    return flat.is_fixed ? 0 : round.is_fixed ? on_fixed : on_dynamic;
  };
  const Vec3f driven = a.is_fixed ? a.spin : b.is_fixed ? b.spin : Vec3f{};
  const float spin = std::min(length(driven), length(b.spin - a.spin));
  return {falls * static_cast<double>(faster * dt), angle(a, b), angle(b, a), static_cast<double>(dt * spin)};
}

Touch with_corners(const ConvexShape& a, const ConvexShape& b, const Posed& pose_of_b, const Touch& found,
                   const Rocking& rocking) {
  const bool swapped = b_is_round(a, b, rocking);
  const Pair pair = swapped ? Pair{b, a, pose_of_b, {}, -found.normal, rocking.on_b, true}
                            : Pair{a, b, {}, pose_of_b, found.normal, rocking.on_a, false};
  if (found.count == 0 || !may_rock(pair)) return found;
  const double reach = std::min(std::sqrt(2 * pair.radius() * rocking.height), pair.steepest * pair.radius());
  const double slack = reach * reach / pair.radius();  // twice the height of what is within reach
  const Feature flat = feature_towards(pair.flat, pair.flat_pose, -pair.outward, slack);
  if (flat.count < 3) return found;
  const TouchPoint& nearest = nearest_of(found);
  const Footprint footprint = footprint_of(pair, flat, swapped ? nearest.on_a : nearest.on_b, reach);
  if (!reaches_sides(pair, flat, footprint, rocking.turning)) return found;
  std::vector<TouchPoint> points =
      points_over(footprint.polygon(pair.outward), flat, found.normal, swapped, any_height);
  const double height = place(pair, points) - nearest.separation;
  if (points.size() < 3 || height > slack) return found;  // the nearest point is not on the flat part
  lower(pair, height, points);
  return four_of(points, found.normal);
}

}  // namespace pliant
