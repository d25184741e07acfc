// The formulas of MotionKernels for bodies, written once: R is float for one body, Wide for sixteen (math/wide.h).
#pragma once

#include "solver/bodies/manifold_rows.h"
#include "solver/frame_formulas.h"

namespace pliant::motion_formulas {

/// The Records of a BodyMotion.
enum BodyRecord : int {
  velocity,
  spin,
  inertia_diagonal,
  inertia_rest,
  displacement,
  rotation,
  kept_velocity,
  kept_spin
};

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
PLIANT_HD void store_inertia(const BodyArrays& a, const BodyLanes<R, lanes>& at, const Quat<R>& q,
                             const Vec3<R>& inverse) {
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

template <class R, int lanes>
PLIANT_HD void load_inertia(const BodyArrays& a, const BodyLanes<R, lanes>& at) {
  const R zero(0.f);
  at.motion.store(at.row(a, velocity), {zero, zero, zero}, at.particle.load(a.positions).w);
  store_inertia(a, at, at.frame.rotation(a.of_frames.orientations), at.frame.vector(a.of_frames.inverse_inertias));
}

template <class R, int lanes>
PLIANT_HD Turned<R> turned_of(const BodyArrays& a, const BodyLanes<R, lanes>& at) {
  return {at.body.rotation(a.start_orientations), at.frame.rotation(a.of_frames.orientations),
          at.frame.vector(a.of_frames.round)};
}

template <class R, int lanes>
PLIANT_HD void load_predicted(const BodyArrays& a, const BodyLanes<R, lanes>& at, float h, bool is_first, float share) {
  const R rate(1 / h);
  const R inverse_mass = at.particle.load(a.positions).w;
  const Turned<R> body = turned_of(a, at);
  Vec3<R> moves = (at.particle.vector(a.displacements) - at.particle.vector(a.remainders)) * rate;
  Vec3<R> turns =
      body.from_world((at.frame.vector(a.of_frames.predicted) + at.frame.vector(a.of_frames.corrections)) * rate);
  at.motion.store(at.row(a, kept_velocity), moves, R(0.f));
  at.motion.store(at.row(a, kept_spin), rotate(body.start, turns), R(0.f));
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
  at.motion.store(at.row(a, spin), rotate(body.start, turns), R(0.f));
}

/// How the motion has changed since it was kept; rotation in the axes of `body` at the frame's start. Adds that to what
/// contacts did.
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
  const Turned<R> body = turned_of(a, at);
  const Quat<R> q = body.now;
  moved = moved * R(h);
  turned = body.to_world(turned) * R(h);
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
  const Turned<R> body = turned_of(a, at);
  const Vec3<R> moved = (x.xyz - at.body.vector(a.start_positions)) +
                        (at.particle.vector(a.remainders) - at.body.vector(a.start_remainders));
  const Vec3<R> turn = at.frame.vector(a.of_frames.predicted) + at.frame.vector(a.of_frames.corrections);
  const Vec3<R> summed = at.motion.vector(at.row(a, rotation)) + rotate(body.start, body.from_world(turn));
  const Vec3<R> turned = body.any_is_round ? select(body.is_round, rotate(body.start, body.swing()), summed) : summed;
  at.motion.store(at.row(a, displacement), moved, zero);
  at.motion.store(at.row(a, rotation), turned, zero);
  const Vec3<R> g{R(gravity.x), R(gravity.y), R(gravity.z)};
  const Vec3<R> v = at.particle.vector(a.velocities) + select(x.w > zero, g, Vec3<R>{zero, zero, zero});
  // Contacts push at the substep's start, and angular momentum that they bring stays in the world while the prediction
  // turns the body.
  const RecordOf<R> spins = at.frame.load(a.of_frames.angular_velocities);
  const Vec3<R> inverse = at.frame.vector(a.of_frames.inverse_inertias);
  const Vec3<R> across = body.across(local(body.now, at.frame.vector(a.of_frames.predicted)));
  const Vec3<R> back = turned_back(inverse, across, body.to_body(at.body.vector(a.pushed_spin)));
  const Vec3<R> spins_now =
      select(is_large_turn(inverse, body.round, at.frame.vector(a.of_frames.corrections)), spins.xyz, spins.xyz + back);
  at.frame.store(a.of_frames.angular_velocities, spins_now, spins.w);
  const Vec3<R> w = rotate(body.start, body.from_body(spins_now));
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
  at.frame.store(a.of_frames.angular_velocities, w.xyz + turned_of(a, at).to_body(turned), w.w);
}

}  // namespace pliant::motion_formulas
