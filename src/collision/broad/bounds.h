// The axis-aligned box, and the interface of bounding volumes (reference/volumes.h: spheres, oriented boxes and
// k-DOPs).
//
// A BVH needs five operations of a volume: enclose points, merge volumes, grow by a margin, test overlap, bound a
// distance. Each result is conservative: its numbers are rounded outward, or computed in double and widened. If two
// volumes overlap, all volumes that enclose them overlap too, so a BVH reports exactly the leaf pairs whose volumes
// overlap. All numbers are in metres; points must be finite and below 1e15.
#pragma once

#include <concepts>

#include "math/vector.h"

namespace pliant {

namespace detail {

/// Returns x lowered by one to two units in the last place: a lower bound of the number that was rounded to x.
inline float rounded_down(float x) { return x - __builtin_fabsf(x) * 1.1920929e-7f; }
inline float rounded_up(float x) { return x + __builtin_fabsf(x) * 1.1920929e-7f; }
inline float float_below(double x) { return rounded_down(static_cast<float>(x)); }
inline float float_above(double x) { return rounded_up(static_cast<float>(x)); }

}  // namespace detail

/// Requirements on a bounding volume type B. B::of(points, count >= 1) and B::merged(volumes, count >= 1) enclose their
/// arguments. a.grown(m >= 0) encloses all points within m of a; overlap(a, b) is symmetric; a.middle() is a point in
/// or near a. a.distance_bound(p) never exceeds the distance from p to any point inside a.
template <class B>
concept Bounds = requires(const B& b, const Vec3f* points, const B* volumes, int count, float margin, const Vec3f& p) {
  { B::of(points, count) } -> std::same_as<B>;
  { B::merged(volumes, count) } -> std::same_as<B>;
  { b.grown(margin) } -> std::same_as<B>;
  { overlap(b, b) } -> std::same_as<bool>;
  { b.distance_bound(p) } -> std::same_as<float>;
  { b.middle() } -> std::same_as<Vec3f>;
};

/// An axis-aligned box. Merging boxes is exact, and so is the box of given points.
struct BoxBounds {
  Vec3f low{}, high{};

  static BoxBounds of(const Vec3f* points, int count);
  static BoxBounds merged(const BoxBounds* boxes, int count);
  BoxBounds grown(float margin) const;
  float distance_bound(const Vec3f& p) const;
  Vec3f middle() const { return 0.5f * low + 0.5f * high; }
};

inline bool overlap(const BoxBounds& a, const BoxBounds& b) {
  // Branch-free: the outcome is unpredictable, and six comparisons cost less than one misprediction.
  return (a.low.x <= b.high.x) & (b.low.x <= a.high.x) & (a.low.y <= b.high.y) & (b.low.y <= a.high.y) &
         (a.low.z <= b.high.z) & (b.low.z <= a.high.z);
}

inline BoxBounds BoxBounds::of(const Vec3f* points, int count) {
  BoxBounds box{points[0], points[0]};
  for (int i = 1; i < count; ++i) box = {min(box.low, points[i]), max(box.high, points[i])};
  return box;
}

inline BoxBounds BoxBounds::merged(const BoxBounds* boxes, int count) {
  BoxBounds all = boxes[0];
  for (int i = 1; i < count; ++i) all = {min(all.low, boxes[i].low), max(all.high, boxes[i].high)};
  return all;
}

inline BoxBounds BoxBounds::grown(float margin) const {
  using detail::rounded_down, detail::rounded_up;
  return {{rounded_down(low.x - margin), rounded_down(low.y - margin), rounded_down(low.z - margin)},
          {rounded_up(high.x + margin), rounded_up(high.y + margin), rounded_up(high.z + margin)}};
}

static_assert(Bounds<BoxBounds>);

}  // namespace pliant
