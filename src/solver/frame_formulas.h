// The formulas of MotionKernels for frames, written once: R is float for one frame, Wide for sixteen (math/wide.h).
//
// Of a wide R it also uses all_zero(R), which is true if a number is zero in all lanes.
#pragma once

#include <cstdint>

#include "math/quat.h"
#include "math/scalar.h"
#include "solver/motion_kernels.h"

namespace pliant::motion_formulas {

PLIANT_HD bool all_zero(float sum) { return sum == 0; }

/// Records of one index, or of one in each lane.
template <class R>
struct RecordOf {
  Vec3<R> xyz;
  R w;
};

PLIANT_HD RecordOf<float> load_records(const Record* base, const std::int32_t* index, float) {
  const Record& r = base[index[0]];
  return {{r.x, r.y, r.z}, r.w};
}
PLIANT_HD void store_records(Record* base, const std::int32_t* index, const RecordOf<float>& r) {
  base[index[0]] = {r.xyz.x, r.xyz.y, r.xyz.z, r.w};
}

/// The indices of one element, or of one in each lane. `count` of them differ; the others repeat the last.
template <class R, int lanes>
struct Lanes {
  std::int32_t index[lanes];

  /// first, first + 1 ... up to last - 1, which the other lanes repeat; each times `stride`.
  PLIANT_HD static Lanes from(int first, int last, int stride = 1) {
    Lanes out;
    for (int lane = 0; lane < lanes; ++lane) out.index[lane] = stride * (first + lane < last ? first + lane : last - 1);
    return out;
  }
  /// The entries of a list.
  PLIANT_HD static Lanes of(const std::int32_t* list, const Lanes& at) {
    Lanes out;
    for (int lane = 0; lane < lanes; ++lane) out.index[lane] = list[at.index[lane]];
    return out;
  }
  PLIANT_HD RecordOf<R> load(const Record* base) const { return load_records(base, index, R{}); }
  PLIANT_HD Vec3<R> vector(const Record* base) const { return load(base).xyz; }
  PLIANT_HD Quat<R> rotation(const Record* base) const {
    const RecordOf<R> r = load(base);
    return {r.xyz.x, r.xyz.y, r.xyz.z, r.w};
  }
  PLIANT_HD void store(Record* base, const Vec3<R>& xyz, const R& w) const {
    store_records(base, index, RecordOf<R>{xyz, w});
  }
  PLIANT_HD void store(Record* base, const Quat<R>& q) const { store(base, {q.x, q.y, q.z}, q.w); }
};

/// Euler's equations without torque in principal axes: dw/dt = I^-1 ((I w) x w), whose components are factor.x w_y w_z
/// and so on. Factors are zero if rotation about an axis is locked.
template <class R>
PLIANT_HD Vec3<R> gyroscopic_factors(const Vec3<R>& inverse, const Vec3<R>& inertia) {
  const R zero(0.f);
  const auto turns = min(min(inverse.x, inverse.y), inverse.z) > zero;
  const Vec3<R> factors{inverse.x * (inertia.y - inertia.z), inverse.y * (inertia.z - inertia.x),
                        inverse.z * (inertia.x - inertia.y)};
  return select(turns, factors, Vec3<R>{zero, zero, zero});
}

/// One step of Newton's method for the implicit midpoint rule, change = h rate(w + change / 2).
template <class R>
PLIANT_HD Vec3<R> gyroscopic_step(const Vec3<R>& f, const Vec3<R>& w, const Vec3<R>& change, const R& h) {
  const R half(0.5f), one(1.f), k = half * h;
  const Vec3<R> m = w + change * half;
  const Vec3<R> left = Vec3<R>{f.x * m.y * m.z, f.y * m.z * m.x, f.z * m.x * m.y} * h - change;
  const Vec3<R> x{one, -(k * f.x * m.z), -(k * f.x * m.y)}, y{-(k * f.y * m.z), one, -(k * f.y * m.x)},
      z{-(k * f.z * m.y), -(k * f.z * m.x), one};
  const Vec3<R> yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
  return change + (yz * left.x + zx * left.y + xy * left.z) * (one / dot(x, yz));
}

/// The inertia whose inverse is given; where that is zero, a number without meaning.
template <class R>
PLIANT_HD Vec3<R> inertia_of(const Vec3<R>& inverse) {
  const R one(1.f), least(1.2e-38f);
  return {one / max(inverse.x, least), one / max(inverse.y, least), one / max(inverse.z, least)};
}

/// By how much the angular velocity w of a frame changes, in its axes, when it is turned by theta (in its axes) without
/// torque: angular momentum L stays in the world, so in the frame it turns back, by 2 (s v x L + v x (v x L)) with the
/// quaternion (v, s). An increment, so that what is not turned does not round. Zero if rotation about an axis is
/// locked.
template <class R>
PLIANT_HD Vec3<R> turned_back(const Vec3<R>& inverse, const Vec3<R>& theta, const Vec3<R>& w) {
  const R zero(0.f), half(0.5f);
  const Vec3<R> inertia = inertia_of(inverse);
  const auto turns = min(min(inverse.x, inverse.y), inverse.z) > zero;
  const Quat<R> back = normalise(Quat<R>{-(half * theta.x), -(half * theta.y), -(half * theta.z), R(1.f)});
  const Vec3<R> v{back.x, back.y, back.z},
      across = cross(v, Vec3<R>{w.x * inertia.x, w.y * inertia.y, w.z * inertia.z});
  const Vec3<R> change = (across * back.w + cross(v, across)) * R(2.f);
  return select(turns, Vec3<R>{change.x * inverse.x, change.y * inverse.y, change.z * inverse.z},
                Vec3<R>{zero, zero, zero});
}

/// By how much the angular velocity w of a frame changes in h without torque, in its axes, by the implicit midpoint
/// rule, which keeps energy. Zero beyond a radian per step, where Newton's method may diverge.
template <class R>
PLIANT_HD Vec3<R> gyroscopic_change(const Vec3<R>& factors, const Vec3<R>& w, const R& h) {
  const Vec3<R> none{R(0.f), R(0.f), R(0.f)};
  if (all_zero(max(max(abs(factors.x), abs(factors.y)), abs(factors.z)))) return none;  // moments of inertia agree
  Vec3<R> change = none;
  for (int round = 0; round < 3; ++round) change = gyroscopic_step(factors, w, change, h);
  return select(length_squared(w) * (h * h) < R(1.f), change, none);
}

/// The free motion of a symmetric top that turns by more than a radian in h, or is round: it turns about its angular
/// momentum, and then about its own axis. Energy and angular momentum stay whatever the angle of the latter, so that is
/// not exact.
template <class R>
struct Spinning {
  using Applies = decltype(R{} > R{});
  bool anywhere;  ///< in some lane; if not, what follows is not set
  /// False where two moments of inertia do not agree to 1e-4, or the frame turns slowly and is not round.
  Applies applies;
  Vec3<R> angle;  ///< about the angular momentum [rad]
  Quat<R> twist;  ///< about the axis

  PLIANT_HD Spinning(const Vec3<R>& inverse, const Vec3<R>& round, const Vec3<R>& w, const R& h) {
    const R zero(0.f), one(1.f), half(0.5f), close(1e-4f);
    const R fast_or_round = max(length_squared(w) * (h * h), (round.x + round.y) + round.z);
    anywhere = !all_zero(select(fast_or_round >= one, one, zero));
    if (!anywhere) return;
    const auto agree = [&](const R& a, const R& b) { return abs(a - b) < close * max(a, b); };
    const Vec3<R> x{one, zero, zero}, y{zero, one, zero}, z{zero, zero, one}, none{zero, zero, zero};
    const Vec3<R> axis = select(agree(inverse.y, inverse.z), x,
                                select(agree(inverse.z, inverse.x), y, select(agree(inverse.x, inverse.y), z, none)));
    const R own = dot(axis, inverse), across = half * ((inverse.x + inverse.y + inverse.z) - own), along = dot(axis, w);
    const R twisting = along * (one - across / max(own, R(1.2e-38f)));
    applies = select(min(min(inverse.x, inverse.y), inverse.z) > zero, dot(axis, axis), zero) * fast_or_round >= one;
    angle = (w - axis * twisting) * h;
    const R t = half * h * twisting;
    twist = normalise(Quat<R>{axis.x * t, axis.y * t, axis.z * t, one});
  }
};

/// A frame's pose and angular velocity at the end of a free motion, and the angle by which it has turned, in the world.
template <class R>
struct FreeTurn {
  Quat<R> orientation;
  Vec3<R> angle, spin;
};

template <class R>
PLIANT_HD FreeTurn<R> free_turn(const Quat<R>& q, const Vec3<R>& inverse, const Vec3<R>& round, const Vec3<R>& w,
                                const R& h) {
  const R half(0.5f), one(1.f);
  const Vec3<R> change = gyroscopic_change(gyroscopic_factors(inverse, inertia_of(inverse)), w, h);
  const Spinning<R> fast(inverse, round, w, h);
  const Vec3<R> slow_angle = (w + change * half) * h;
  const Vec3<R> angle = fast.anywhere ? select(fast.applies, fast.angle, slow_angle) : slow_angle;
  // Taylor series of the quaternion exponential. The next terms are below a float's precision up to half a radian per
  // substep.
  const R t = length_squared(angle) * R(0.25f), imaginary = half * (one - t * R(1 / 6.f));
  const Quat<R> turn{angle.x * imaginary, angle.y * imaginary, angle.z * imaginary,
                     one - t * half + t * t * R(1 / 24.f)};
  const FreeTurn<R> slow{normalise(multiply(q, turn)), rotate(q, angle), w + change};
  if (!fast.anywhere) return slow;
  const Quat<R> spun = multiply(slow.orientation, fast.twist), &turned = slow.orientation;
  const Vec3<R> spin = rotate(conjugate(fast.twist), w);
  return {{select(fast.applies, spun.x, turned.x), select(fast.applies, spun.y, turned.y),
           select(fast.applies, spun.z, turned.z), select(fast.applies, spun.w, turned.w)},
          select(fast.applies, rotate(spun, spin * h), slow.angle),
          select(fast.applies, spin, slow.spin)};
}

template <class R, int lanes>
PLIANT_HD void predict_frames(const FrameArrays& a, const Lanes<R, lanes>& at, float step) {
  const R zero(0.f);
  const Quat<R> q = at.rotation(a.orientations);
  const FreeTurn<R> turned =
      free_turn(q, at.vector(a.inverse_inertias), at.vector(a.round), at.vector(a.angular_velocities), R(step));
  at.store(a.starts, q);
  at.store(a.predicted, turned.angle, zero);
  at.store(a.orientations, turned.orientation);
  at.store(a.angular_velocities, turned.spin, zero);
  at.store(a.corrections, {zero, zero, zero}, zero);
}

template <class R>
PLIANT_HD Vec3<R> local(const Quat<R>& orientation, const Vec3<R>& v) {
  return rotate(conjugate(orientation), v);
}

/// How contacts see a body that has turned since the frame's start: as it was then, so its arms to the contacts and its
/// inertia, which are those of the frame's start, fit one another. Contacts turn with the body, but not about an axis
/// about which it is round: the place where a ball touches the ground stays below its centre.
template <class R>
struct Turned {
  using IsRound = decltype(R{} > R{});
  Quat<R> start, now;
  Vec3<R> round;
  Quat<R> twist;  ///< of the turn from start to now, what is about the axes about which the body is round
  IsRound is_round;
  bool any_is_round;  ///< in some lane

  PLIANT_HD Turned(const Quat<R>& at_start, const Quat<R>& present, const Vec3<R>& round_axes)
      : start(at_start), now(present), round(round_axes) {
    const R axes = (round.x + round.y) + round.z;
    is_round = axes > R(0.f);
    any_is_round = !all_zero(axes);
    twist = {R(0.f), R(0.f), R(0.f), R(1.f)};
    if (!any_is_round) return;
    const Quat<R> turn = multiply(conjugate(start), now);
    twist = normalise(Quat<R>{turn.x * round.x, turn.y * round.y, turn.z * round.z, turn.w});
  }
  /// From the body's axes to those in which contacts are, and back.
  PLIANT_HD Vec3<R> from_body(const Vec3<R>& v) const {
    return any_is_round ? select(is_round, rotate(twist, v), v) : v;
  }
  PLIANT_HD Vec3<R> to_body(const Vec3<R>& v) const { return any_is_round ? select(is_round, local(twist, v), v) : v; }
  /// The turn from start to now without the twist, in the body's axes [rad].
  PLIANT_HD Vec3<R> swing() const {
    const Quat<R> rest = multiply(multiply(conjugate(start), now), conjugate(twist));
    const R two = select(rest.w < R(0.f), R(-2.f), R(2.f));
    return {rest.x * two, rest.y * two, rest.z * two};
  }
  /// A turn without what is about axes about which the body is round.
  PLIANT_HD Vec3<R> across(const Vec3<R>& v) const {
    const R one(1.f);
    return {v.x * (one - round.x), v.y * (one - round.y), v.z * (one - round.z)};
  }
  /// From the world, and back.
  PLIANT_HD Vec3<R> from_world(const Vec3<R>& v) const { return from_body(local(now, v)); }
  PLIANT_HD Vec3<R> to_world(const Vec3<R>& v) const { return rotate(now, to_body(v)); }
};

/// True where a body is turned so far, for its inertia, that angular momentum which stays in the world while it turns
/// would bring more than a hundredth of its energy. Of bodies that are round about an axis, only those that are slender
/// along it.
template <class R>
PLIANT_HD auto is_large_turn(const Vec3<R>& inverse, const Vec3<R>& round, const Vec3<R>& theta) {
  const R most = max(max(inverse.x, inverse.y), inverse.z), least = min(min(inverse.x, inverse.y), inverse.z),
          zero(0.f);
  const R excess = length_squared(theta) * (most - least),
          slender = select(dot(round, inverse) > R(10.f) * least, excess, zero);
  return select((round.x + round.y) + round.z > zero, slender, excess) > R(0.02f) * least;
}

/// The angular velocity after a substep in which a frame that ends with `w` without torque is turned by theta at the
/// start, in its axes. Keeps the energy that it has with the latter, whatever its inertia; angular momentum to first
/// order in the angle.
template <class R>
PLIANT_HD Vec3<R> pushed_at_start(const Vec3<R>& inverse, const Vec3<R>& round, const Vec3<R>& w, const Vec3<R>& theta,
                                  const R& h) {
  const R half(-0.5f), rate = R(1.f) / h;
  const Vec3<R> factors = gyroscopic_factors(inverse, inertia_of(inverse));
  const Vec3<R> pushed = (w + gyroscopic_change(factors, w, -h)) + theta * rate;
  const Quat<R> twist =
      normalise(Quat<R>{half * theta.x * round.x, half * theta.y * round.y, half * theta.z * round.z, R(1.f)});
  return select((round.x + round.y) + round.z > R(0.f), rotate(twist, w + theta * rate),
                pushed + gyroscopic_change(factors, pushed, h));
}

/// Zero if all values are finite, else not a number.
template <class R, int lanes>
PLIANT_HD R update_frames(const FrameArrays& a, const Lanes<R, lanes>& at, float h, float share) {
  const Quat<R> q = at.rotation(a.orientations);
  const RecordOf<R> correction = at.load(a.corrections);
  const Vec3<R> before = at.vector(a.angular_velocities), theta = rotate(conjugate(q), correction.xyz);
  const Vec3<R> inverse = at.vector(a.inverse_inertias), round = at.vector(a.round);
  Vec3<R> w = before + (theta * R(share / h) + turned_back(inverse, theta, before));
  const auto is_large = is_large_turn(inverse, round, correction.xyz);
  if (!all_zero(select(is_large, R(1.f), R(0.f))))  // seldom
    w = select(is_large, pushed_at_start(inverse, round, before, theta * R(share), R(h)), w);
  w = w * correction.w;
  at.store(a.angular_velocities, w, R(0.f));
  return ((w.x - w.x) + (w.y - w.y) + (w.z - w.z)) + ((q.x - q.x) + (q.y - q.y) + (q.z - q.z) + (q.w - q.w));
}

}  // namespace pliant::motion_formulas
