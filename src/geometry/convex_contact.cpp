#include "geometry/convex_contact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "geometry/convex_distance.h"
#include "geometry/polyhedron_contact.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// A feature is flat to the other solid if its points differ in height by no more than this share of its size, or by
/// the margin.
constexpr double flat_share = 0.1;
/// The nearest place is a point of contact where all others are higher by this share of the smaller solid's size.
constexpr double higher = 0.001;
/// Polygons that face each other less than this serve no clipping [cosine].
constexpr double least_facing = 0.9;

constexpr double nearly = 1e-6;    ///< directions that differ by less count as one [1 - cosine]: 0.08 degrees
constexpr double exactly = 3e-12;  ///< directions that differ by less are equal but for rounding [1 - cosine]

constexpr std::uint32_t nearest_point_feature = 0x20000000u;  ///< TouchPoint::feature of the nearest places

/// True for polyhedra without a radius and with so few edges that all pairs of them are tried.
bool are_polyhedra(const ConvexShape& a, const ConvexShape& b) {
  const auto is_simple = [](const ConvexShape& shape) {
    return shape.kind == ConvexShape::Kind::polyhedron && shape.radius == 0 && shape.polyhedron->edges.size() <= 64;
  };
  return is_simple(a) && is_simple(b);
}

double size_of(const ConvexShape& shape) {
  if (shape.kind == ConvexShape::Kind::polyhedron)
    return static_cast<double>(largest(shape.polyhedron->corners[0] - shape.polyhedron->centre));
  return static_cast<double>(std::max(shape.core_radius, shape.half_length));
}

Feature facing_feature(const ConvexShape& shape, const Posed& pose, const Vec3d& direction, double margin,
                       double turning) {
  const double slack = std::max(std::min(margin, flat_share * size_of(shape)), turning);
  return feature_towards(shape, pose, direction, slack);
}

/// Two segments that are nearly parallel: where they lie side by side, one is a narrow polygon to the other.
Feature widened(const Feature& segment, const Vec3d& outward) {
  const Vec3d along = segment.points[1] - segment.points[0], side = cross(outward, along);
  Feature out;
  out.count = 4;
  out.points = {segment.points[0] - side, segment.points[1] - side, segment.points[1] + side, segment.points[0] + side};
  out.normal = unit_or(cross(along, side), outward);
  if (dot(out.normal, outward) < 0) {
    std::reverse(out.points.begin(), out.points.begin() + 4);
    out.normal = -out.normal;
  }
  return out;
}

bool are_parallel(const Feature& a, const Feature& b) {
  const Vec3d u = a.points[1] - a.points[0], v = b.points[1] - b.points[0];
  return dot(u, v) * dot(u, v) > 0.99 * length_squared(u) * length_squared(v);
}

/// Replaces a direction by the face's normal where they differ by more than rounding and less than `nearly`. A capsule
/// that has sunk a little into one of two flush boxes is tilted against the edge between them, and would slide off.
void take_normal(const Feature& face, double sign, ConvexDistance& nearest) {
  if (face.count < 3) return;
  const Vec3d normal = unit_or(face.normal * sign, nearest.normal);  // faces of hulls have normals in single precision
  const double away = 0.5 * length_squared(normal - nearest.normal);
  if (!(away > exactly && away < nearly)) return;
  nearest.normal = normal;
  nearest.on_a = nearest.on_b - nearest.normal * nearest.separation;
}

/// The points of two features, between cores; none if one of them is a point, or segments cross.
std::vector<TouchPoint> points_between(const Feature& a, const Feature& b, const Vec3d& normal, double margin) {
  if (a.count < 2 || b.count < 2) return {};
  if (a.count == 2 && b.count == 2) {
    if (!are_parallel(a, b)) return {};
    return points_over(widened(a, normal), b, normal, false, margin);
  }
  const double of_a = a.count > 2 ? dot(a.normal, normal) : 0, of_b = b.count > 2 ? -dot(b.normal, normal) : 0;
  if (std::max(of_a, of_b) < least_facing) return {};
  return of_a >= of_b ? points_over(a, b, normal, false, margin) : points_over(b, a, normal, true, margin);
}

}  // namespace

Feature feature_towards(const ConvexShape& shape, const Posed& pose, const Vec3d& direction, double slack) {
  Feature feature = feature_towards(shape, rotate(conjugate(pose.rotation), direction), slack);
  for (int i = 0; i < feature.count; ++i) {
    Vec3d& point = feature.points[static_cast<std::size_t>(i)];
    point = to_world(pose, point);
  }
  feature.normal = rotate(pose.rotation, feature.normal);
  return feature;
}

Touch touch(const ConvexShape& a, const ConvexShape& b, const Posed& pose_of_b, double margin, double turning) {
  if (are_polyhedra(a, b)) {
    thread_local Polyhedron placed;  // to allocate nothing
    move(*b.polyhedron, convert<float>(pose_of_b), placed);
    return touch(*a.polyhedron, placed, static_cast<float>(margin));
  }
  ConvexDistance nearest = convex_distance(a, b, pose_of_b, margin);
  if (nearest.separation > margin) return {};
  if (a.kind == ConvexShape::Kind::point || b.kind == ConvexShape::Kind::point)
    return four_of({{nearest.on_a, nearest.on_b, nearest.separation, nearest_point_feature}}, nearest.normal);
  const double radius_a = static_cast<double>(a.radius), radius_b = static_cast<double>(b.radius);
  const Feature of_a = facing_feature(a, {}, nearest.normal, margin, turning),
                of_b = facing_feature(b, pose_of_b, -nearest.normal, margin, turning);
  take_normal(of_a, 1, nearest);
  take_normal(of_b, -1, nearest);
  const Vec3d normal = nearest.normal;
  std::vector<TouchPoint> points = points_between(of_a, of_b, normal, margin + radius_a + radius_b);
  double deepest = margin;
  for (TouchPoint& point : points) {
    point.on_a += normal * radius_a;
    point.on_b -= normal * radius_b;
    point.separation -= radius_a + radius_b;
    deepest = std::min(deepest, point.separation);
  }
  const double error = higher * std::min(size_of(a), size_of(b)) + 1e-6;
  const bool has_all = !points.empty() && deepest <= nearest.separation + error;
  if (!has_all) points.push_back({nearest.on_a, nearest.on_b, nearest.separation, nearest_point_feature});
  return four_of(points, normal);
}

Touch touch_half_space(const ConvexShape& b, const Posed& pose_of_b, double margin, double turning) {
  const Vec3d up{0, 1, 0};
  const double radius = static_cast<double>(b.radius);
  const Vec3d down = rotate(conjugate(pose_of_b.rotation), -up);
  const Vec3d deepest = to_world(pose_of_b, support(b, down)) - up * radius;
  const double depth = -deepest.y;  // all that is below the surface touches
  const Feature lowest = facing_feature(b, pose_of_b, -up, margin, std::max(turning, depth));
  std::vector<TouchPoint> points;
  for (int i = 0; i < lowest.count; ++i) {
    const Vec3d on_b = lowest.points[static_cast<std::size_t>(i)] - up * radius;
    if (on_b.y <= margin) points.push_back({{on_b.x, 0, on_b.z}, on_b, on_b.y, static_cast<std::uint32_t>(i)});
  }
  // The flattest part need not hold the deepest place.
  double least = margin;
  for (const TouchPoint& point : points) least = std::min(least, point.separation);
  if (deepest.y < least - (higher * size_of(b) + 1e-6))
    points.push_back({{deepest.x, 0, deepest.z}, deepest, deepest.y, nearest_point_feature});
  return points.empty() ? Touch{} : four_of(points, up);
}

}  // namespace pliant
