// The closest point of a segment to a primitive solid.
//
// Along a segment, the signed distance to a convex solid is a convex function.
// Its minimum is where the slope changes sign, which bracketing finds.
#pragma once

#include "geometry/shapes.h"

namespace pliant {

/// A point on a segment a b.
template <class R>
struct ClosestToShape {
  R t{};             ///< share of the segment from a to b, 0..1
  R distance{};      ///< signed distance to the solid [m]
  Vec3<R> normal{};  ///< unit outward normal; perpendicular to the segment within rounding if 0 < t < 1
};

/// A segment and a solid, with the signed distances at both ends.
template <class R>
struct SegmentNearShape {
  LocalShape shape;
  Vec3<R> a, edge;  ///< first end of the segment, and the vector to its second end
  SurfaceDistance<R> at_a, at_b;

  PLIANT_HD SegmentNearShape(const LocalShape& solid, const Vec3<R>& from, const Vec3<R>& to)
      : shape(solid), a(from), edge(to - from), at_a(signed_distance(solid, from)), at_b(signed_distance(solid, to)) {}

  PLIANT_HD SurfaceDistance<R> at(const R& t) const { return signed_distance(shape, a + edge * t); }
  PLIANT_HD R slope(const SurfaceDistance<R>& surface) const { return dot(surface.normal, edge); }

  /// True if an interior point of the segment is closer to the solid than both ends.
  PLIANT_HD bool dips() const { return slope(at_a) < R(0) && slope(at_b) > R(0); }

  /// Lower bound of the distance from the tangents at both ends [m]. Valid only if dips().
  PLIANT_HD R lower_bound() const {
    const R down = slope(at_a), up = slope(at_b);
    const R t = clamp((at_b.distance - up - at_a.distance) / (down - up), R(0), R(1));
    return max(at_a.distance + down * t, at_b.distance + up * (t - R(1)));
  }
};

namespace detail {

/// Two points on a segment with their distances, between which the slope changes sign.
template <class R>
struct Bracket {
  R low, high;
  SurfaceDistance<R> at_low, at_high;
};

/// Finds where along a segment the slope of the distance first exceeds `threshold`, to within `exact`: at `high` it
/// does, at `low` it does not. Regula falsi converges fast for round solids; every third step bisects, which finds
/// kinks too.
template <class R>
PLIANT_HD void narrow(const SegmentNearShape<R>& segment, const R& threshold, const R& exact, Bracket<R>& b) {
  constexpr int steps = sizeof(R) == sizeof(float) ? 48 : 120;
  R low_excess = segment.slope(b.at_low) - threshold, high_excess = segment.slope(b.at_high) - threshold;
  if (!(low_excess < R(0))) {  // the slope exceeds the threshold everywhere
    b.high = b.low;
    b.at_high = b.at_low;
  } else if (!(high_excess > R(0))) {
    b.low = b.high;
    b.at_low = b.at_high;
  }
  for (int step = 0; step < steps && b.high - b.low > R(sizeof(R) == sizeof(float) ? 4e-6f : 1e-13f); ++step) {
    const R share = step % 3 == 2 ? R(0.5f) : clamp(low_excess / (low_excess - high_excess), R(0.01f), R(0.99f));
    const R between = b.low + (b.high - b.low) * share;
    const SurfaceDistance<R> there = segment.at(between);
    const R excess = segment.slope(there) - threshold;
    const bool exceeds = excess > R(0);
    (exceeds ? b.high : b.low) = between;
    (exceeds ? b.at_high : b.at_low) = there;
    (exceeds ? high_excess : low_excess) = excess;
    if (abs(excess) <= exact) break;
  }
}

/// The point of least distance in a narrow bracket. If the distance has a kink there, as inside a box, the contact is
/// with the solid's edge: no face normal is perpendicular to the segment, but the interpolated normal is.
template <class R>
PLIANT_HD ClosestToShape<R> closest_in(const SegmentNearShape<R>& segment, const Bracket<R>& b) {
  const R down = segment.slope(b.at_low), up = segment.slope(b.at_high);
  const bool low_is_closer = b.at_low.distance <= b.at_high.distance;
  const SurfaceDistance<R>& closer = low_is_closer ? b.at_low : b.at_high;
  const ClosestToShape<R> found{low_is_closer ? b.low : b.high, closer.distance, closer.normal};
  const R share = up - down > R(0) ? clamp(up / (up - down), R(0), R(1)) : R(1);
  const Vec3<R> between = b.at_low.normal * share + b.at_high.normal * (R(1) - share);
  const R size = length(between);
  if (!(size > R(0.5f))) return found;  // the segment enters through one face and leaves through the opposite one
  return {found.t, found.distance / size, between * (R(1) / size)};
}

}  // namespace detail

/// The point closest to the solid on a segment that dips(); any of them if
/// there are several. The distance is accurate to 1e-5 of the segment's length.
template <class R>
PLIANT_HD ClosestToShape<R> closest_between(const SegmentNearShape<R>& segment) {
  detail::Bracket<R> b{R(0), R(1), segment.at_a, segment.at_b};
  detail::narrow(segment, R(0), R(2e-5f) * length(segment.edge), b);
  return detail::closest_in(segment, b);
}

/// Up to two points on a segment that dips(): the closest one, or both ends of a nearly parallel stretch, as across a
/// box or along a capsule. Two points keep the segment from rocking.
template <class R>
struct ClosestStretch {
  int places = 0;
  ClosestToShape<R> place[2];
};

template <class R>
PLIANT_HD ClosestStretch<R> closest_stretch(const SegmentNearShape<R>& segment) {
  const R parallel = R(0.02f) * length(segment.edge), beside = R(0.1f);
  const ClosestToShape<R> closest = closest_between(segment);
  const bool before = segment.slope(segment.at(max(closest.t - beside, R(0)))) >= -parallel;
  const bool after = segment.slope(segment.at(min(closest.t + beside, R(1)))) <= parallel;
  if (!before && !after) return {1, {closest, {}}};
  detail::Bracket<R> first{R(0), closest.t, segment.at_a, segment.at(closest.t)},
      last{closest.t, R(1), first.at_high, segment.at_b};
  detail::narrow(segment, -parallel, R(0.1f) * parallel, first);
  detail::narrow(segment, parallel, R(0.1f) * parallel, last);
  return {2,
          {{first.high, first.at_high.distance, first.at_high.normal},
           {last.low, last.at_low.distance, last.at_low.normal}}};
}

}  // namespace pliant
