// The formulas of MotionKernels, written once: R is float for one frame or body, Wide for sixteen (math/wide.h).
#pragma once

#include <cstdint>

#include "math/quat.h"
#include "math/scalar.h"
#include "solver/bodies/manifold_rows.h"
#include "solver/motion_kernels.h"

namespace pliant::motion_formulas {

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

// ---------------------------------------------------------------- frames

/// Euler's equations without torque in principal axes: dw/dt = I^-1 ((I w) x w), whose components are factor.x w_y w_z and so on.
/// Factors are zero if rotation about an axis is locked.
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

/// By how much the angular velocity w of a frame changes, in its axes, when it is turned by theta (in its axes) without torque:
/// angular momentum L stays in the world, so in the frame it turns back, by 2 (s v x L + v x (v x L)) with the quaternion (v, s). An
/// increment, so that what is not turned does not round. Zero if rotation about an axis is locked.
template <class R>
PLIANT_HD Vec3<R> turned_back(const Vec3<R>& inverse, const Vec3<R>& theta, const Vec3<R>& w) {
  const R zero(0.f), half(0.5f);
  const Vec3<R> inertia = inertia_of(inverse);
  const auto turns = min(min(inverse.x, inverse.y), inverse.z) > zero;
  const Quat<R> back = normalise(Quat<R>{-(half * theta.x), -(half * theta.y), -(half * theta.z), R(1.f)});
  const Vec3<R> v{back.x, back.y, back.z}, across = cross(v, Vec3<R>{w.x * inertia.x, w.y * inertia.y, w.z * inertia.z});
  const Vec3<R> change = (across * back.w + cross(v, across)) * R(2.f);
  return select(turns, Vec3<R>{change.x * inverse.x, change.y * inverse.y, change.z * inverse.z},
                Vec3<R>{zero, zero, zero});
}

template <class R, int lanes>
PLIANT_HD void predict_frames(const FrameArrays& a, const Lanes<R, lanes>& at, float step) {
  const R h(step), half(0.5f), one(1.f);
  const Quat<R> q = at.rotation(a.orientations);
  const Vec3<R> inverse = at.vector(a.inverse_inertias), inertia = inertia_of(inverse), none{R(0.f), R(0.f), R(0.f)};
  const Vec3<R> w = at.vector(a.angular_velocities);
  const Vec3<R> factors = gyroscopic_factors(inverse, inertia);
  Vec3<R> change = none;
  for (int round = 0; round < 3; ++round) change = gyroscopic_step(factors, w, change, h);
  change = select(length_squared(w) * (h * h) < one, change, none);  // beyond a radian per substep the steps may diverge
  const Vec3<R> angle = (w + change * half) * h;
  // Taylor series of the quaternion exponential. The next terms are below a float's precision up to half a radian per
  // substep.
  const R t = length_squared(angle) * R(0.25f), imaginary = half * (one - t * R(1 / 6.f));
  const Quat<R> turn{angle.x * imaginary, angle.y * imaginary, angle.z * imaginary, one - t * half + t * t * R(1 / 24.f)};
  at.store(a.starts, q);
  at.store(a.predicted, rotate(q, angle), R(0.f));
  at.store(a.orientations, normalise(multiply(q, turn)));
  at.store(a.angular_velocities, w + change, R(0.f));
  at.store(a.corrections, {R(0.f), R(0.f), R(0.f)}, R(0.f));
}

/// Zero if all values are finite, else not a number.
template <class R, int lanes>
PLIANT_HD R update_frames(const FrameArrays& a, const Lanes<R, lanes>& at, float inverse_h) {
  const Quat<R> q = at.rotation(a.orientations);
  const RecordOf<R> correction = at.load(a.corrections);
  const Vec3<R> before = at.vector(a.angular_velocities), theta = rotate(conjugate(q), correction.xyz);
  const Vec3<R> back = turned_back(at.vector(a.inverse_inertias), theta, before);
  const Vec3<R> w = (before + (theta * R(inverse_h) + back)) * correction.w;
  at.store(a.angular_velocities, w, R(0.f));
  return ((w.x - w.x) + (w.y - w.y) + (w.z - w.z)) + ((q.x - q.x) + (q.y - q.y) + (q.z - q.z) + (q.w - q.w));
}

// ---------------------------------------------------------------- bodies

/// The Records of a BodyMotion.
enum BodyRecord : int { velocity, spin, inertia_diagonal, inertia_rest, displacement, rotation, kept_velocity, kept_spin };

template <class R, int lanes>
struct BodyLanes {
  Lanes<R, lanes> body, particle, frame, motion;

  PLIANT_HD BodyLanes(const BodyArrays& a, int first, int last)
      : body(Lanes<R, lanes>::from(first, last)),
        particle(Lanes<R, lanes>::of(a.particles, body)),
        frame(Lanes<R, lanes>::of(a.frames, body)),
        motion(Lanes<R, lanes>::from(first, last, records_a_motion)) {}

  PLIANT_HD static Record* row(const BodyArrays& a, BodyRecord record) {
    return reinterpret_cast<Record*>(a.motions) + record;
  }
};

/// The elements of R diag(inverse) R^T in world axes, as BodyMotion has them.
template <class R, int lanes>
PLIANT_HD void store_inertia(const BodyArrays& a, const BodyLanes<R, lanes>& at, const Quat<R>& q, const Vec3<R>& inverse) {
  const R zero(0.f), one(1.f);
  const Vec3<R> x = rotate(q, Vec3<R>{one, zero, zero}), y = rotate(q, Vec3<R>{zero, one, zero}),
                z = rotate(q, Vec3<R>{zero, zero, one});
  const Vec3<R> rows[3] = {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
  const auto element = [&](const Vec3<R>& r, const Vec3<R>& c) __attribute__((always_inline)) {
    return inverse.x * (r.x * c.x) + inverse.y * (r.y * c.y) + inverse.z * (r.z * c.z);
  };
  at.motion.store(at.row(a, inertia_diagonal),
                  {element(rows[0], rows[0]), element(rows[1], rows[1]), element(rows[2], rows[2])},
                  element(rows[1], rows[2]));
  at.motion.store(at.row(a, inertia_rest), {element(rows[2], rows[0]), element(rows[0], rows[1]), zero}, zero);
}

/// A vector in the body's axes: as it turns with the body from the frame's start to now.
template <class R>
PLIANT_HD Vec3<R> local(const Quat<R>& orientation, const Vec3<R>& v) {
  return rotate(conjugate(orientation), v);
}

template <class R, int lanes>
PLIANT_HD void load_inertia(const BodyArrays& a, const BodyLanes<R, lanes>& at) {
  const R zero(0.f);
  at.motion.store(at.row(a, velocity), {zero, zero, zero}, at.particle.load(a.positions).w);
  store_inertia(a, at, at.frame.rotation(a.of_frames.orientations), at.frame.vector(a.of_frames.inverse_inertias));
}

// Contacts see spins and rotations as they were at the frame's start: turned back by what the body has turned since. So its arms to the
// contacts and its inertia, which are those of the frame's start, fit one another, as if the points turned with the body.

template <class R, int lanes>
PLIANT_HD void load_predicted(const BodyArrays& a, const BodyLanes<R, lanes>& at, float h, bool is_first, float share) {
  const R rate(1 / h);
  const R inverse_mass = at.particle.load(a.positions).w;
  const Quat<R> start = at.body.rotation(a.start_orientations), now = at.frame.rotation(a.of_frames.orientations);
  Vec3<R> moves = (at.particle.vector(a.displacements) - at.particle.vector(a.remainders)) * rate;
  Vec3<R> turns = local(now, (at.frame.vector(a.of_frames.predicted) + at.frame.vector(a.of_frames.corrections)) * rate);
  at.motion.store(at.row(a, kept_velocity), moves, R(0.f));
  at.motion.store(at.row(a, kept_spin), rotate(start, turns), R(0.f));
  if (is_first) {
    const Vec3<R> none{R(0.f), R(0.f), R(0.f)};
    if (share > 0) {
      moves += at.body.vector(a.pushed) * R(share);
      turns += at.body.vector(a.pushed_spin) * R(share);
    }
    at.body.store(a.pushed, none, R(0.f));
    at.body.store(a.pushed_spin, none, R(0.f));
  }
  at.motion.store(at.row(a, velocity), moves, inverse_mass);
  at.motion.store(at.row(a, spin), rotate(start, turns), R(0.f));
}

/// How the motion has changed since it was kept; rotation in the body's axes. Adds that to what contacts did.
template <class R, int lanes>
PLIANT_HD void take_change(const BodyArrays& a, const BodyLanes<R, lanes>& at, Vec3<R>& moved, Vec3<R>& turned) {
  moved = at.motion.vector(at.row(a, velocity)) - at.motion.vector(at.row(a, kept_velocity));
  turned = local(at.body.rotation(a.start_orientations),
                 at.motion.vector(at.row(a, spin)) - at.motion.vector(at.row(a, kept_spin)));
  at.body.store(a.pushed, at.body.vector(a.pushed) + moved, R(0.f));
  at.body.store(a.pushed_spin, at.body.vector(a.pushed_spin) + turned, R(0.f));
}

template <class R, int lanes>
PLIANT_HD void store_predicted(const BodyArrays& a, const BodyLanes<R, lanes>& at, float h) {
  Vec3<R> moved, turned;
  take_change(a, at, moved, turned);
  const Quat<R> q = at.frame.rotation(a.of_frames.orientations);
  moved = moved * R(h);
  turned = rotate(q, turned) * R(h);
  const RecordOf<R> d = at.particle.load(a.displacements), c = at.frame.load(a.of_frames.corrections);
  at.particle.store(a.displacements, d.xyz + moved, d.w);
  at.frame.store(a.of_frames.corrections, c.xyz + turned, c.w);
  const Quat<R> by = multiply(Quat<R>{turned.x, turned.y, turned.z, R(0.f)}, q);
  const R half(0.5f);
  at.frame.store(a.of_frames.orientations,
                 normalise(Quat<R>{q.x + half * by.x, q.y + half * by.y, q.z + half * by.z, q.w + half * by.w}));
}

template <class R, int lanes>
PLIANT_HD void load_velocities(const BodyArrays& a, const BodyLanes<R, lanes>& at, const Vec3f& gravity) {
  const R zero(0.f);
  const RecordOf<R> x = at.particle.load(a.positions);
  const Quat<R> start = at.body.rotation(a.start_orientations), now = at.frame.rotation(a.of_frames.orientations);
  const Vec3<R> moved =
      (x.xyz - at.body.vector(a.start_positions)) + (at.particle.vector(a.remainders) - at.body.vector(a.start_remainders));
  const Vec3<R> turned =
      at.motion.vector(at.row(a, rotation)) +
      rotate(start, local(now, at.frame.vector(a.of_frames.predicted) + at.frame.vector(a.of_frames.corrections)));
  at.motion.store(at.row(a, displacement), moved, zero);
  at.motion.store(at.row(a, rotation), turned, zero);
  const Vec3<R> g{R(gravity.x), R(gravity.y), R(gravity.z)};
  const Vec3<R> v = at.particle.vector(a.velocities) + select(x.w > zero, g, Vec3<R>{zero, zero, zero});
  // Contacts push at the substep's start, and angular momentum that they bring stays in the world while the prediction turns the body.
  const RecordOf<R> spins = at.frame.load(a.of_frames.angular_velocities);
  const Vec3<R> spins_now =
      spins.xyz + turned_back(at.frame.vector(a.of_frames.inverse_inertias),
                              local(now, at.frame.vector(a.of_frames.predicted)), at.body.vector(a.pushed_spin));
  at.frame.store(a.of_frames.angular_velocities, spins_now, spins.w);
  const Vec3<R> w = rotate(start, spins_now);
  at.motion.store(at.row(a, velocity), v, x.w);
  at.motion.store(at.row(a, spin), w, zero);
  at.motion.store(at.row(a, kept_velocity), v, zero);
  at.motion.store(at.row(a, kept_spin), w, zero);
}

template <class R, int lanes>
PLIANT_HD void store_velocities(const BodyArrays& a, const BodyLanes<R, lanes>& at) {
  Vec3<R> moved, turned;
  take_change(a, at, moved, turned);
  const RecordOf<R> v = at.particle.load(a.velocities), w = at.frame.load(a.of_frames.angular_velocities);
  at.particle.store(a.velocities, v.xyz + moved, v.w);
  at.frame.store(a.of_frames.angular_velocities, w.xyz + turned, w.w);
}

}  // namespace pliant::motion_formulas
