// Building blocks of constraint formulas: scalars, rotations, slots and rows.
//
// A formula is a template over its scalar type: float projects one constraint, Wide sixteen, and double is what tests
// compare with. All functions below exist for the three types (those for Wide are found by argument-dependent lookup),
// so one text gives the same bits everywhere. That is why min and max return the second argument if the first is NaN,
// or if both are zero: the instructions minps and maxps of SSE do so.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "pliant/vec3.h"

namespace pliant {

// ---------------------------------------------------------------- scalars

/// Returns `a` where `mask` is true, else `b`.
PLIANT_HD float select(bool mask, float a, float b) { return mask ? a : b; }
PLIANT_HD double select(bool mask, double a, double b) { return mask ? a : b; }

/// The smaller of two numbers; b if they are equal or one is NaN.
PLIANT_HD float min(float a, float b) { return a < b ? a : b; }
PLIANT_HD double min(double a, double b) { return a < b ? a : b; }

/// The larger of two numbers; b if they are equal or one is NaN.
PLIANT_HD float max(float a, float b) { return a > b ? a : b; }
PLIANT_HD double max(double a, double b) { return a > b ? a : b; }

/// The absolute value. It clears the sign bit, also that of zero and NaN.
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

/// The inverse of a rotation; q must be a unit quaternion.
template <class R>
PLIANT_HD Quat<R> conjugate(const Quat<R>& q) {
  return {-q.x, -q.y, -q.z, q.w};
}

/// The Hamilton product a b: the rotation that applies b first, then a.
template <class R>
PLIANT_HD Quat<R> multiply(const Quat<R>& a, const Quat<R>& b) {
  return {a.w * b.x + a.x * b.w + (a.y * b.z - a.z * b.y), a.w * b.y + a.y * b.w + (a.z * b.x - a.x * b.z),
          a.w * b.z + a.z * b.w + (a.x * b.y - a.y * b.x), a.w * b.w - (a.x * b.x + a.y * b.y + a.z * b.z)};
}

/// Rotates v by the unit quaternion q: v + 2 u x (u x v + w v), where u is the imaginary part of q.
template <class R>
PLIANT_HD Vec3<R> rotate(const Quat<R>& q, const Vec3<R>& v) {
  const Vec3<R> u{q.x, q.y, q.z};
  const Vec3<R> turned = cross(u, cross(u, v) + q.w * v);
  return v + (turned + turned);
}

// ---------------------------------------------------------------- plasticity

/// How much of a deformation becomes permanent in one substep (Plasticity).
struct PlasticFlow {
  float yield;  ///< what stays elastic
  float share;  ///< of what is beyond, the share that flows, 0..1
  float most;   ///< greatest permanent deformation
};

// ---------------------------------------------------------------- slots and rows

/// The two kinds of slot of a constraint.
class Point;  ///< a particle; its value is a position
class Frame;  ///< an orientation; its value is a unit quaternion from the frame's principal axes to the world

enum class SlotKind : std::uint8_t { point, frame };

/// The kinds of a constraint's slots in order, one to eight: Slots<Point, Frame, Point, Frame>.
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

/// Slots of n points.
template <int n>
using Points = typename detail::PointSlots<std::make_index_sequence<static_cast<std::size_t>(n)>>::Type;

/// The values of a constraint's slots. Positions are relative to the first point, so C does not depend on the origin.
template <class S, class R>
struct SlotValues {
  Vec3<R> point[static_cast<std::size_t>(S::count)];  ///< position of each slot [m]; unused for frames
  Quat<R> frame[static_cast<std::size_t>(S::count)];  ///< orientation of each slot; unused for points
};

/// What evaluate fills: C and its gradients, one row for each component of C.
template <class S, int rows, class R>
struct Rows {
  R c[static_cast<std::size_t>(rows)];
  /// Gradients by row and slot. For a point: dC/dx. For a frame: dC/dtheta for a small rotation vector theta in world
  /// axes. A point at r from the frame's point moves by theta x r, so a gradient g with respect to it adds r x g.
  Vec3<R> gradient[static_cast<std::size_t>(rows)][static_cast<std::size_t>(S::count)];
  /// Bounds of the force of each row, in the direction in which C grows [J / unit of C]. Types with `is_bounded` fill
  /// them.
  R low[static_cast<std::size_t>(rows)], high[static_cast<std::size_t>(rows)];
  /// The speed that a row imposes on C [unit of C / s]. Types with `acts_on_motion` fill it.
  R speed[static_cast<std::size_t>(rows)];
};

}  // namespace pliant
