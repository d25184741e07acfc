// Rotations as unit quaternions, and rigid poses of a rotation and a translation.
//
// Interpolation takes the shorter arc: q and -q are the same rotation, and which of them a tool exported must not
// matter.
#pragma once

#include "math/functions.h"
#include "math/vector.h"

namespace pliant {

using Quatd = Quat<double>;

template <class To, class From>
PLIANT_HD Quat<To> convert(const Quat<From>& q) {
  return {static_cast<To>(q.x), static_cast<To>(q.y), static_cast<To>(q.z), static_cast<To>(q.w)};
}

template <class R>
PLIANT_HD R dot(const Quat<R>& a, const Quat<R>& b) {
  return (a.x * b.x + a.y * b.y) + (a.z * b.z + a.w * b.w);
}

/// The unit quaternion q / |q|; the identity if |q|^2 is below the smallest normal float.
template <class R>
PLIANT_HD Quat<R> normalise(const Quat<R>& q) {
  const R squared = dot(q, q), least = R(1.17549435e-38f);
  const R scale = R(1) / sqrt(max(squared, least));
  const auto zero = squared < least;
  return {select(zero, R(0), q.x * scale), select(zero, R(0), q.y * scale), select(zero, R(0), q.z * scale),
          select(zero, R(1), q.w * scale)};
}

/// Normalised linear interpolation (1 - share) a + share b on the shorter arc: cheap, nearly uniform for close
/// rotations.
template <class R>
PLIANT_HD Quat<R> nlerp(const Quat<R>& a, const Quat<R>& b, const R& share) {
  const R first = R(1) - share, second = select(dot(a, b) < R(0), -share, share);
  return normalise(Quat<R>{first * a.x + second * b.x, first * a.y + second * b.y, first * a.z + second * b.z,
                           first * a.w + second * b.w});
}

/// The rotation at `share` of the shorter arc from a to b (unit quaternions), at constant angular speed. For rotations
/// half a turn apart, the signs as given decide the direction.
PLIANT_HD Quatd slerp(const Quatd& a, const Quatd& b, double share) {
  const Quatd near = dot(a, b) < 0 ? Quatd{-b.x, -b.y, -b.z, -b.w} : b;
  const Quatd difference{near.x - a.x, near.y - a.y, near.z - a.z, near.w - a.w};
  const Quatd sum{near.x + a.x, near.y + a.y, near.z + a.z, near.w + a.w};
  // By atan2, because acos of a dot product near 1 loses half of its digits.
  const double angle = 2 * atan2(sqrt(dot(difference, difference)), sqrt(dot(sum, sum)));
  if (angle < 1e-6) return nlerp(a, near, share);
  const double scale = 1 / sin(angle), first = sin((1 - share) * angle) * scale, second = sin(share * angle) * scale;
  return normalise(Quatd{first * a.x + second * near.x, first * a.y + second * near.y, first * a.z + second * near.z,
                         first * a.w + second * near.w});
}

/// A rigid transform p -> rotation p + position.
template <class R>
struct Pose {
  Vec3<R> position{};  ///< translation [m]
  Quat<R> rotation{};  ///< unit quaternion
};
using Posef = Pose<float>;
using Posed = Pose<double>;

template <class To, class From>
PLIANT_HD Pose<To> convert(const Pose<From>& pose) {
  return {convert<To>(pose.position), convert<To>(pose.rotation)};
}

/// Converts a point from the pose's frame to world coordinates.
template <class R>
PLIANT_HD Vec3<R> to_world(const Pose<R>& pose, const Vec3<R>& local) {
  return rotate(pose.rotation, local) + pose.position;
}

/// Converts a point from world coordinates to the pose's frame.
template <class R>
PLIANT_HD Vec3<R> to_local(const Pose<R>& pose, const Vec3<R>& world) {
  return rotate(conjugate(pose.rotation), world - pose.position);
}

/// The composition of two poses, which applies `inner` first.
template <class R>
PLIANT_HD Pose<R> compose(const Pose<R>& outer, const Pose<R>& inner) {
  return {to_world(outer, inner.position), normalise(multiply(outer.rotation, inner.rotation))};
}

}  // namespace pliant
