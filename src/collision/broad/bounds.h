// The axis-aligned box, and what a hierarchy needs of any volume (reference/volumes.h has spheres, oriented boxes and k-DOPs).
//
// A hierarchy asks four things of a volume, whatever it is: to hold some points, to hold other volumes, to grow by a margin, and
// whether two of them overlap; and for nearest points a bound on the distance to a point. What holds must hold in spite of
// rounding: numbers are rounded outward, or made in double and widened, so that where two volumes overlap so do any that hold
// them, and a hierarchy gives exactly the pairs whose own volumes overlap. All numbers in metres; points finite and below 1e15.
#pragma once

#include <concepts>

#include "math/vector.h"

namespace pliant {

namespace detail {

/// Below a number by one to two units in its last place: what rounding to nearest may have added is taken off again.
inline float rounded_down(float x) { return x - __builtin_fabsf(x) * 1.1920929e-7f; }
inline float rounded_up(float x) { return x + __builtin_fabsf(x) * 1.1920929e-7f; }
inline float float_below(double x) { return rounded_down(static_cast<float>(x)); }
inline float float_above(double x) { return rounded_up(static_cast<float>(x)); }

}  // namespace detail

/// What a hierarchy needs of a volume B: B::of(points, count >= 1) and B::merged(volumes, count >= 1) hold what they are given;
/// grown(m >= 0) holds all within m of it; overlap(a, b) is symmetric; distance_bound(p) is never more than the distance of p
/// to anything in it; middle() is a point in or near it.
template <class B>
concept Bounds = requires(const B& b, const Vec3f* points, const B* volumes, int count, float margin, const Vec3f& p) {
  { B::of(points, count) } -> std::same_as<B>;
  { B::merged(volumes, count) } -> std::same_as<B>;
  { b.grown(margin) } -> std::same_as<B>;
  { overlap(b, b) } -> std::same_as<bool>;
  { b.distance_bound(p) } -> std::same_as<float>;
  { b.middle() } -> std::same_as<Vec3f>;
};

/// An axis-aligned box. Merging and refitting are exact.
struct BoxBounds {
  Vec3f low{}, high{};

  static BoxBounds of(const Vec3f* points, int count);
  static BoxBounds merged(const BoxBounds* boxes, int count);
  BoxBounds grown(float margin) const;
  float distance_bound(const Vec3f& p) const;
  Vec3f middle() const { return 0.5f * low + 0.5f * high; }
};

inline bool overlap(const BoxBounds& a, const BoxBounds& b) {
  // No branches: the answer is as good as random, and six comparisons are cheaper than one wrong guess.
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
