// Building blocks of constraint formulas: scalars, rotations, slots and rows.
//
// A formula is a template over its scalar type: float projects one constraint, Wide sixteen, and
// double serves as the tests' oracle. These functions exist for all three (argument-dependent lookup
// finds those of Wide), so the same code gives the same bits everywhere. Hence min and max are the
// comparison of SSE's minps and maxps: if a is NaN, or both are zero, they return the second argument.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "pliant/vec3.h"

namespace pliant {

// ---------------------------------------------------------------- scalars

/// `a` where the mask holds, else `b`.
PLIANT_HD float select(bool mask, float a, float b) { return mask ? a : b; }
PLIANT_HD double select(bool mask, double a, double b) { return mask ? a : b; }

/// The smaller; b if they are unordered or equal.
PLIANT_HD float min(float a, float b) { return a < b ? a : b; }
PLIANT_HD double min(double a, double b) { return a < b ? a : b; }

/// The larger; b if they are unordered or equal.
PLIANT_HD float max(float a, float b) { return a > b ? a : b; }
PLIANT_HD double max(double a, double b) { return a > b ? a : b; }

/// The magnitude: clears the sign bit, also of zero and NaN.
PLIANT_HD float abs(float a) { return __builtin_fabsf(a); }
PLIANT_HD double abs(double a) { return __builtin_fabs(a); }

/// The square root, correctly rounded on every machine that follows IEEE 754; NaN below zero.
PLIANT_HD float sqrt(float a) {
#if defined(__CUDA_ARCH__)
  return __fsqrt_rn(a);
#else
  return __builtin_sqrtf(a);
#endif
}
PLIANT_HD double sqrt(double a) {
#if defined(__CUDA_ARCH__)
  return __dsqrt_rn(a);
#else
  return __builtin_sqrt(a);
#endif
}

/// `a` clamped to [low, high]; `high` wins if low > high.
template <class R>
PLIANT_HD R clamp(const R& a, const R& low, const R& high) {
  return min(max(a, low), high);
}

// ---------------------------------------------------------------- rotations

/// The inverse rotation of a unit quaternion.
template <class R>
PLIANT_HD Quat<R> conjugate(const Quat<R>& q) {
  return {-q.x, -q.y, -q.z, q.w};
}

/// Hamilton product: applies rotation b, then a.
template <class R>
PLIANT_HD Quat<R> multiply(const Quat<R>& a, const Quat<R>& b) {
  return {a.w * b.x + a.x * b.w + (a.y * b.z - a.z * b.y), a.w * b.y + a.y * b.w + (a.z * b.x - a.x * b.z),
          a.w * b.z + a.z * b.w + (a.x * b.y - a.y * b.x), a.w * b.w - (a.x * b.x + a.y * b.y + a.z * b.z)};
}

/// v rotated by the unit quaternion q: v + 2 u x (u x v + w v), u the imaginary part.
template <class R>
PLIANT_HD Vec3<R> rotate(const Quat<R>& q, const Vec3<R>& v) {
  const Vec3<R> u{q.x, q.y, q.z};
  const Vec3<R> turned = cross(u, cross(u, v) + q.w * v);
  return v + (turned + turned);
}

// ---------------------------------------------------------------- slots and rows

/// The two kinds of slot.
class Point;  ///< a particle: its position
class Frame;  ///< an orientation: a unit quaternion from the frame's principal axes to the world

enum class SlotKind : std::uint8_t { point, frame };

/// The slots of a constraint in stencil order, one to eight: Slots<Point, Frame, Point, Frame>.
template <class... Kinds>
struct Slots {
  static_assert(sizeof...(Kinds) >= 1 && sizeof...(Kinds) <= 8, "a stencil has one to eight slots");
  static_assert(((std::is_same_v<Kinds, Point> || std::is_same_v<Kinds, Frame>)&&...), "a slot is a Point or a Frame");
  static constexpr int count = static_cast<int>(sizeof...(Kinds));
  static constexpr int frames = (0 + ... + (std::is_same_v<Kinds, Frame> ? 1 : 0));
  static constexpr std::array<SlotKind, sizeof...(Kinds)> kinds{
      (std::is_same_v<Kinds, Frame> ? SlotKind::frame : SlotKind::point)...};
};

namespace detail {
template <class Indices>
struct PointSlots;
template <std::size_t... index>
struct PointSlots<std::index_sequence<index...>> {
  template <std::size_t>
  struct One {
    using Type = Point;
  };
  using Type = Slots<typename One<index>::Type...>;
};
}  // namespace detail

/// n points.
template <int n>
using Points = typename detail::PointSlots<std::make_index_sequence<static_cast<std::size_t>(n)>>::Type;

/// The current slot values. Positions are relative to the first point, so constraints are independent of the origin.
template <class S, class R>
struct SlotValues {
  Vec3<R> point[static_cast<std::size_t>(S::count)];  ///< by slot; unused for frames [m]
  Quat<R> frame[static_cast<std::size_t>(S::count)];  ///< by slot; unused for points
};

/// C and its gradients, one row for each component of C.
template <class S, int rows, class R>
struct Rows {
  R c[static_cast<std::size_t>(rows)];
  /// By row and slot. For a point: dC/dx. For a frame: dC/dtheta, with a small rotation vector theta in world axes. A point
  /// r of the frame then moves by theta x r, so a gradient g at r contributes r x g.
  Vec3<R> gradient[static_cast<std::size_t>(rows)][static_cast<std::size_t>(S::count)];
};

}  // namespace pliant
