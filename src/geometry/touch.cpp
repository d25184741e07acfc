#include "geometry/touch.h"

#include <algorithm>
#include <cstddef>

#include "math/vector.h"

namespace pliant {

namespace {

/// A side of the clipped feature: its own edge, or a side of the polygon by which it was clipped.
using Side = std::uint32_t;
constexpr Side first_side_of_polygon = 64;  ///< edges of the feature have smaller numbers
constexpr int bits_of_side = 8;
constexpr std::uint32_t is_swapped = 0x40000000u;

/// A corner of the clipped feature, and the sides that meet there, which name it.
struct ClipPoint {
  Vec3d place{};
  Side before = 0, after = 0;
};
using ClipPolygon = std::vector<ClipPoint>;

void set_corners(const Feature& feature, ClipPolygon& out) {
  out.clear();
  for (int i = 0; i < feature.count; ++i)
    out.push_back({feature.points[static_cast<std::size_t>(i)],
                   static_cast<Side>((i + feature.count - 1) % feature.count), static_cast<Side>(i)});
}

/// Keeps what lies behind a plane, n.x <= offset. A polygon gets a side of the number `side` there. A segment is a
/// polygon of two equal edges, so that each cut gives its point twice; the second has no number of its own and is left
/// out.
void clip(const ClipPolygon& corners, const Vec3d& n, double offset, Side side, bool is_segment, ClipPolygon& out) {
  out.clear();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const ClipPoint &from = corners[i], &to = corners[(i + 1) % corners.size()];
    const double start = dot(n, from.place) - offset, end = dot(n, to.place) - offset;
    if (start <= 0) out.push_back(from);
    if (!((start < 0 && end > 0) || (start > 0 && end < 0)) || (is_segment && i == 1)) continue;
    const Vec3d place = from.place + (to.place - from.place) * (start / (start - end));
    out.push_back(start < 0 ? ClipPoint{place, from.after, side} : ClipPoint{place, side, from.after});
  }
}

}  // namespace

std::vector<TouchPoint> points_over(const Feature& polygon, const Feature& other, const Vec3d& normal, bool swapped,
                                    double margin) {
  thread_local ClipPolygon corners, next;  // to allocate nothing
  set_corners(other, corners);
  for (int i = 0; i < polygon.count && !corners.empty(); ++i) {
    const Vec3d &a = polygon.points[static_cast<std::size_t>(i)],
                &b = polygon.points[static_cast<std::size_t>((i + 1) % polygon.count)];
    const Vec3d outward = cross(b - a, polygon.normal);
    clip(corners, outward, dot(outward, a), first_side_of_polygon + static_cast<Side>(i), other.count == 2, next);
    corners.swap(next);
  }
  std::vector<TouchPoint> points;
  points.reserve(corners.size() + 1);                // and one for the nearest place
  const double slope = dot(polygon.normal, normal);  // near 1, or near -1 if swapped
  for (const ClipPoint& corner : corners) {
    const double along = dot(polygon.normal, polygon.points[0] - corner.place) / slope;
    const Vec3d below = corner.place + normal * along;
    const double separation = swapped ? along : -along;
    if (separation > margin) continue;
    const std::uint32_t feature = (swapped ? is_swapped : 0u) ^ corner.before << bits_of_side ^ corner.after;
    points.push_back(swapped ? TouchPoint{corner.place, below, separation, feature}
                             : TouchPoint{below, corner.place, separation, feature});
  }
  return points;
}

Touch four_of(const std::vector<TouchPoint>& points, const Vec3d& normal) {
  Touch out;
  out.normal = normal;
  if (points.size() <= out.points.size()) {
    for (const TouchPoint& point : points) out.points[static_cast<std::size_t>(out.count++)] = point;
    return out;
  }
  const auto best = [&](const auto& value) {
    std::size_t found = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
      if (value(points[i]) > value(points[found])) found = i;
    return found;
  };
  const std::size_t first = best([](const TouchPoint& p) { return -p.separation; });
  const Vec3d origin = points[first].on_a;
  const std::size_t second = best([&](const TouchPoint& p) { return length_squared(p.on_a - origin); });
  const Vec3d sideways = cross(normal, points[second].on_a - origin);
  const std::size_t third = best([&](const TouchPoint& p) { return dot(sideways, p.on_a - origin); });
  const std::size_t fourth = best([&](const TouchPoint& p) { return -dot(sideways, p.on_a - origin); });
  std::array<std::size_t, 4> chosen{first, second, third, fourth};
  std::sort(chosen.begin(), chosen.end());
  const auto end = std::unique(chosen.begin(), chosen.end());
  for (auto i = chosen.begin(); i != end; ++i) out.points[static_cast<std::size_t>(out.count++)] = points[*i];
  return out;
}

}  // namespace pliant
