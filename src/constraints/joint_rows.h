// Rows from which the joints of rigid bodies are made. A body is a point, its centre of mass, and a frame.
//
//   d   = anchor of b - anchor of a             u_k = axis k of the joint frame fixed in a      v_k = the same, fixed in b
//   displacement along k:  C = u_k . d
//   alignment of i and k:  C = u_i . v_k        zero while the two are perpendicular
//   twist about x:         C = 2 atan2(p_x, p_w), p the rotation from the joint frame of a to that of b
//
// C is measured in the joint frame of a, so rigid motion does not change it; where anchors coincide, in world axes.
#pragma once

#include <array>
#include <cstddef>

#include "math/functions.h"
#include "math/quat.h"
#include "pliant/formula.h"

namespace pliant::joint {

/// The slots of a joint: the points and frames of bodies a and b.
using Bodies = Slots<Point, Frame, Point, Frame>;

/// "No limit" for a force or a speed in rest data, which are finite.
inline constexpr float no_limit = 1e30f;
/// A motor of a given torque or force is one of a speed that nothing reaches [rad/s or m/s], whose greatest torque
/// acts.
inline constexpr float speed_of_torque = 1e6f, least_torque = 1e-30f;

/// Where a joint is fixed in its two bodies. Numbers are relative to each body's centre and principal axes.
template <class R>
struct Places {
  Vec3<R> anchor_a, anchor_b;  ///< [m]
  Quat<R> axes_a, axes_b;      ///< from the joint frame to the principal axes
};

/// The names of the members of Places, as rest fields.
inline constexpr std::array<const char*, 14> place_fields{
    "anchor_a_x", "anchor_a_y", "anchor_a_z", "anchor_b_x", "anchor_b_y", "anchor_b_z", "axes_a_x",
    "axes_a_y",   "axes_a_z",   "axes_a_w",   "axes_b_x",   "axes_b_y",   "axes_b_z",   "axes_b_w"};

/// The same, followed by more names.
template <std::size_t n>
constexpr std::array<const char*, 14 + n> place_fields_and(const std::array<const char*, n>& more) {
  std::array<const char*, 14 + n> all{};
  for (std::size_t i = 0; i < 14 + n; ++i) all[i] = i < 14 ? place_fields[i] : more[i - 14];
  return all;
}

/// Rest fields of joint_angle_motor and joint_offset_motor after the places.
inline constexpr int motor_target = 14, motor_speed = 17, motor_most = 18;

/// The places of a joint at the centre of b, with the world's axes as its frame.
template <class R>
PLIANT_HD Places<R> measure_places(const SlotValues<Bodies, R>& at) {
  return {rotate(conjugate(at.frame[1]), at.point[2] - at.point[0]), Vec3<R>{R(0), R(0), R(0)}, conjugate(at.frame[1]),
          conjugate(at.frame[3])};
}

template <class R>
PLIANT_HD Vec3<R> unit(int axis) {
  return {R(axis == 0 ? 1.f : 0.f), R(axis == 1 ? 1.f : 0.f), R(axis == 2 ? 1.f : 0.f)};
}

template <class R>
PLIANT_HD R component(const Vec3<R>& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// A joint at the present pose of its bodies.
template <class R>
struct Posed {
  Vec3<R> arm_a, arm_b;      ///< from each centre to the anchor [m]
  Vec3<R> gap;               ///< d [m]
  Quat<R> frame_a, frame_b;  ///< from the joint frame to the world

  PLIANT_HD Vec3<R> axis_of_a(int axis) const { return rotate(frame_a, unit<R>(axis)); }
  PLIANT_HD Vec3<R> axis_of_b(int axis) const { return rotate(frame_b, unit<R>(axis)); }
};

template <class R>
PLIANT_HD Posed<R> pose(const SlotValues<Bodies, R>& at, const Places<R>& p) {
  const Vec3<R> a = rotate(at.frame[1], p.anchor_a), b = rotate(at.frame[3], p.anchor_b);
  return {a, b, (at.point[2] + b) - (at.point[0] + a), multiply(at.frame[1], p.axes_a),
          multiply(at.frame[3], p.axes_b)};
}

/// Row `row`: displacement along an axis of a.
template <int rows, class R>
PLIANT_HD void displacement(const Posed<R>& joint, int axis, int row, Rows<Bodies, rows, R>& out) {
  const Vec3<R> u = joint.axis_of_a(axis);
  out.c[row] = dot(u, joint.gap);
  out.gradient[row][0] = -u;
  out.gradient[row][1] = -cross(joint.arm_a + joint.gap, u);
  out.gradient[row][2] = u;
  out.gradient[row][3] = cross(joint.arm_b, u);
}

/// Rows 0 to 2: the anchors coincide. C is d in world axes, so gradients do not depend on the gap.
template <int rows, class R>
PLIANT_HD void coincidence(const Posed<R>& joint, Rows<Bodies, rows, R>& out) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3<R> e = unit<R>(axis);
    out.c[axis] = component(joint.gap, axis);
    out.gradient[axis][0] = -e;
    out.gradient[axis][1] = -cross(joint.arm_a, e);
    out.gradient[axis][2] = e;
    out.gradient[axis][3] = cross(joint.arm_b, e);
  }
}

/// Sets the gradients of a row that only depends on rotations; `g` is that of the frame of b.
template <int rows, class R>
PLIANT_HD void set_rotation(const Vec3<R>& g, int row, Rows<Bodies, rows, R>& out) {
  out.gradient[row][0] = out.gradient[row][2] = {R(0), R(0), R(0)};
  out.gradient[row][1] = -g;
  out.gradient[row][3] = g;
}

/// Row `row`: axis `of_a` of a stays perpendicular to axis `of_b` of b.
template <int rows, class R>
PLIANT_HD void alignment(const Posed<R>& joint, int of_a, int of_b, int row, Rows<Bodies, rows, R>& out) {
  const Vec3<R> u = joint.axis_of_a(of_a), v = joint.axis_of_b(of_b);
  out.c[row] = dot(u, v);
  set_rotation(cross(v, u), row, out);
}

/// The rotation from the joint frame of a to that of b, with a real part that is not negative.
template <class R>
PLIANT_HD Quat<R> relative(const Quat<R>& frame_a, const Quat<R>& frame_b) {
  const Quat<R> p = multiply(conjugate(frame_a), frame_b);
  const R sign = select(p.w < R(0), R(-1), R(1));
  return {sign * p.x, sign * p.y, sign * p.z, sign * p.w};
}

/// Row `row`: component `axis` of twice the imaginary part of the relative rotation. Three of them lock it.
template <int rows, class R>
PLIANT_HD void rotation(const Posed<R>& joint, const Quat<R>& p, int axis, int row, Rows<Bodies, rows, R>& out) {
  const Vec3<R> v{p.x, p.y, p.z}, e = unit<R>(axis);
  out.c[row] = R(2) * component(v, axis);
  set_rotation(rotate(joint.frame_a, e * p.w + cross(v, e)), row, out);
}

/// An angle and its gradient by the rotation of b; that by the rotation of a is the negative.
template <class R>
struct Twist {
  R angle;           ///< -pi to pi [rad]
  Vec3<R> gradient;  ///< in world axes
};

/// The twist about x of frame b against frame a. It has no direction where x of b is opposite to x of a.
template <class R>
PLIANT_HD Twist<R> twist_of(const Quat<R>& frame_a, const Quat<R>& frame_b) {
  const Quat<R> p = relative(frame_a, frame_b);
  const Vec3<R> v{p.x, p.y, p.z}, e = unit<R>(0);
  const R scale = R(1) / max(p.w * p.w + p.x * p.x, R(1e-12f));
  return {R(2) * atan2(p.x, p.w), rotate(frame_a, (e * (p.w * p.w) + cross(v, e) * p.w + v * p.x) * scale)};
}

/// Row `row`: the twist about the joint's x-axis.
template <int rows, class R>
PLIANT_HD void twist(const Posed<R>& joint, int row, Rows<Bodies, rows, R>& out) {
  const Twist<R> found = twist_of(joint.frame_a, joint.frame_b);
  out.c[row] = found.angle;
  set_rotation(found.gradient, row, out);
}

/// An angle between -2 pi and 2 pi, brought between -pi and pi [rad].
template <class R>
PLIANT_HD R wrap(const R& angle) {
  const R pi = constant<R>(3.14159265358979324), turn = constant<R>(6.28318530717958648);
  return select(angle > pi, angle - turn, select(angle < -pi, angle + turn, angle));
}

/// The integer nearest to a number below 2^22 in size: adding this number leaves no bit for a fraction.
template <class R>
PLIANT_HD R nearest_integer(const R& x) {
  const R shift = R(12582912.f);
  return (x + shift) - shift;
}
template <>
PLIANT_HD double nearest_integer<double>(const double& x) {
  return (x + 6755399441055744.0) - 6755399441055744.0;
}

/// Any angle, brought between -pi and pi [rad].
template <class R>
PLIANT_HD R wrap_turns(const R& angle) {
  const R turn = constant<R>(6.28318530717958648);
  return angle - turn * nearest_integer(angle / turn);
}

/// Sets the C of a row to the distance from the nearer bound of a range, and its bounds to a force up to `most` that
/// acts inwards only. A range without width is met from both sides.
template <class Out, class R>
PLIANT_HD void bound(const R& above_low, const R& below_high, const R& most, int row, Out& out) {
  const R zero = R(0), width = above_low + below_high;
  const auto is_above = above_low > below_high, is_range = width > zero;
  out.c[row] = select(is_above, -below_high, above_low);
  out.low[row] = select(is_range, select(is_above, -most, zero), -most);
  out.high[row] = select(is_range, select(is_above, zero, most), most);
}

}  // namespace pliant::joint
