// The passes over contacts of bodies, written once: R is float for one manifold, Wide for sixteen (math/wide.h).
//
// All points of a manifold move in the relative motion at their centre, of which only three numbers act on them: the
// velocity along the normal and the spins about both tangents. Impulses at points are a force and two moments in the
// same three directions. So bodies are read and written once for all four points.
#pragma once

#include "math/rows.h"
#include "math/scalar.h"
#include "math/vector.h"
#include "solver/bodies/manifold_passes.h"
#include "solver/bodies/manifold_rows.h"
#include "solver/project.h"

namespace pliant::manifold_formulas {

/// Of a wide R: math/lane_bits.h.
PLIANT_HD bool all_zero(float value) { return value == 0; }

/// Least value of a divisor.
constexpr float tiny = 1e-30f;
/// Later than any arrival [s].
constexpr float never = 1e30f;
/// Passes over the points of a manifold that bounce together: with four, of points that arrive as one, the wrong ones
/// keep an impulse.
constexpr int passes_of_impact = 16;
/// Most passes over a contact that begins at rest.
constexpr int passes_of_settling = 8;
/// Such a contact slides at this multiple of the speed that it may keep, or is left as it is: other passes bring it to
/// rest.
constexpr float clearly_sliding = 10;
/// Friction that asks for no more than this multiple of what it may be is held there; what asks for more slides. A
/// position pass leaves a share of the normal impulse out, and what is at rest should not slip by that.
constexpr float hardly_more = 1.1f;
/// Points that arrive within this share of the substep bounce together; of all at once, those that arrive late would be
/// thrown by the first.
constexpr float together_share = 0.02f;

template <class R>
PLIANT_HD R get(const float* row) {
  R value;
  load_row(row, value);
  return value;
}
template <class R, int lanes>
PLIANT_HD Vec3<R> get(const float (&row)[3][lanes]) {
  return {get<R>(row[0]), get<R>(row[1]), get<R>(row[2])};
}

/// The motion of a body in each lane (BodyMotion).
template <class R>
struct Motion {
  Vec3<R> velocity, spin;
  R inverse_mass;
  R inverse_inertia[6];  ///< xx, yy, zz, yz, zx, xy
};

/// Displacement and rotation of a body since the frame's start.
template <class R>
struct Moved {
  Vec3<R> displacement, rotation;
};

/// What an impulse does to a body's spin.
template <class R>
PLIANT_HD Vec3<R> turned(const Motion<R>& body, const Vec3<R>& v) {
  const R* m = body.inverse_inertia;
  return {m[0] * v.x + m[5] * v.y + m[4] * v.z, m[5] * v.x + m[1] * v.y + m[3] * v.z,
          m[4] * v.x + m[3] * v.y + m[2] * v.z};
}

/// Adds an impulse at the centre and a moment to b, and the opposite to a.
template <class R, int lanes>
PLIANT_HD void add(const ManifoldRows<lanes>& m, const Vec3<R>& impulse, const Vec3<R>& moment, Motion<R>& a,
                   Motion<R>& b) {
  a.velocity -= impulse * a.inverse_mass;
  a.spin -= turned(a, cross(get<R>(m.arm_a), impulse) + moment);
  b.velocity += impulse * b.inverse_mass;
  b.spin += turned(b, cross(get<R>(m.arm_b), impulse) + moment);
}

/// The relative velocity of two bodies at the centre of their points.
template <class R, int lanes>
PLIANT_HD Vec3<R> approach(const ManifoldRows<lanes>& m, const Motion<R>& a, const Motion<R>& b) {
  return (b.velocity + cross(b.spin, get<R>(m.arm_b))) - (a.velocity + cross(a.spin, get<R>(m.arm_a)));
}

/// Relative motion along the normal and about both tangents, in which all points of a manifold move.
template <class R>
struct Wrench {
  R n, one, two;
};

template <class R, int lanes>
PLIANT_HD Wrench<R> along(const ManifoldRows<lanes>& m, const Vec3<R>& motion, const Vec3<R>& turn) {
  const Vec3<R> normal = get<R>(m.normal), tangent = get<R>(m.tangent);
  return {dot(motion, normal), dot(turn, tangent), dot(turn, cross(normal, tangent))};
}

template <class R, int lanes>
PLIANT_HD R at_point(const ManifoldRows<lanes>& m, int i, const Wrench<R>& motion) {
  return motion.n + get<R>(m.y[i]) * motion.one - get<R>(m.x[i]) * motion.two;
}

/// The symmetric matrix K that an impulse and two moments multiply (Manifold::mobility).
template <class R>
struct Mobility {
  R k[6];
};
template <class R, int lanes>
PLIANT_HD Mobility<R> mobility_of(const ManifoldRows<lanes>& m) {
  return {{get<R>(m.mobility[0]), get<R>(m.mobility[1]), get<R>(m.mobility[2]), get<R>(m.mobility[3]),
           get<R>(m.mobility[4]), get<R>(m.mobility[5])}};
}

/// What a unit impulse at a point does to the motion.
template <class R, int lanes>
PLIANT_HD Wrench<R> answer(const ManifoldRows<lanes>& m, const Mobility<R>& of, int i) {
  const R y = get<R>(m.y[i]), x = get<R>(m.x[i]);
  return {of.k[0] + of.k[5] * y - of.k[4] * x, of.k[5] + of.k[1] * y - of.k[3] * x,
          of.k[4] + of.k[3] * y - of.k[2] * x};
}

template <class R>
PLIANT_HD void push(const Wrench<R>& answer, const R& impulse, Wrench<R>& motion) {
  motion.n += impulse * answer.n;
  motion.one += impulse * answer.one;
  motion.two += impulse * answer.two;
}

/// The force and moments of impulses at the points.
template <class R>
struct PointImpulses {
  R at[4];
};

template <class R, int lanes>
PLIANT_HD void apply(const ManifoldRows<lanes>& m, const PointImpulses<R>& impulse, Motion<R>& a, Motion<R>& b) {
  const R* const p = impulse.at;
  const R n = (p[0] + p[1]) + (p[2] + p[3]);
  const R one = (get<R>(m.y[0]) * p[0] + get<R>(m.y[1]) * p[1]) + (get<R>(m.y[2]) * p[2] + get<R>(m.y[3]) * p[3]);
  const R two = (get<R>(m.x[0]) * p[0] + get<R>(m.x[1]) * p[1]) + (get<R>(m.x[2]) * p[2] + get<R>(m.x[3]) * p[3]);
  const Vec3<R> normal = get<R>(m.normal), tangent = get<R>(m.tangent);
  add(m, normal * n, tangent * one - cross(normal, tangent) * two, a, b);
}

template <class R, int lanes>
PLIANT_HD PointImpulses<R> impulses_of(const ManifoldRows<lanes>& m) {
  return {{get<R>(m.impulse[0]), get<R>(m.impulse[1]), get<R>(m.impulse[2]), get<R>(m.impulse[3])}};
}

/// The sum of the normal impulses.
template <class R, int lanes>
PLIANT_HD R pressing(const ManifoldRows<lanes>& m) {
  const PointImpulses<R> impulse = impulses_of<R>(m);
  return (impulse.at[0] + impulse.at[1]) + (impulse.at[2] + impulse.at[3]);
}

/// Friction at the centre: inside of a disc of the normal impulse times the coefficient, and a twist within the normal
/// impulse times an arm.
template <class R, int lanes>
PLIANT_HD void rub(ManifoldRows<lanes>& m, Motion<R>& a, Motion<R>& b) {
  const Vec3<R> velocity = approach(m, a, b), spin = b.spin - a.spin;
  const Vec3<R> normal = get<R>(m.normal), first = get<R>(m.tangent), second = cross(normal, first);
  // A drift of +0, as of all surfaces that do not move along themselves, changes no bit.
  const R u = dot(velocity, first) - get<R>(m.drift[0]), v = dot(velocity, second) - get<R>(m.drift[1]);
  const R before[2] = {get<R>(m.friction_impulse[0]), get<R>(m.friction_impulse[1])};
  const R both = get<R>(m.slide[2]);
  const R wanted[2] = {before[0] - (get<R>(m.slide[0]) * u + both * v),
                       before[1] - (get<R>(m.slide[1]) * v + both * u)};
  const R pressed = pressing<R>(m), limit = get<R>(m.friction) * pressed;
  const R size = sqrt(wanted[0] * wanted[0] + wanted[1] * wanted[1]);
  const R share = select(size <= R(hardly_more) * limit, R(1.f), get<R>(m.sliding));
  const R scale = select(size <= limit, R(1.f), share * limit / max(size, R(tiny)));
  const R after[2] = {wanted[0] * scale, wanted[1] * scale};
  const R twist_limit = pressed * get<R>(m.twist_arm), old_twist = get<R>(m.twist_impulse);
  const R twist = min(max(old_twist - dot(spin, normal) * get<R>(m.twist_mass), -twist_limit), twist_limit);
  store_row(m.friction_impulse[0], after[0]);
  store_row(m.friction_impulse[1], after[1]);
  store_row(m.twist_impulse, twist);
  add(m, first * (after[0] - before[0]) + second * (after[1] - before[1]), normal * (twist - old_twist), a, b);
}

/// Adds a moment to b, and the opposite to a, where there is rolling friction: elsewhere not even the sign of a zero
/// may change.
template <class R, int lanes>
PLIANT_HD void add_moment(const ManifoldRows<lanes>& m, const Vec3<R>& moment, Motion<R>& a, Motion<R>& b) {
  const auto rolls = get<R>(m.rolling) > R(0.f);
  a.spin = select(rolls, a.spin - turned(a, moment), a.spin);
  b.spin = select(rolls, b.spin + turned(b, moment), b.spin);
}

/// Friction against rolling: a moment about the tangents, inside of a disc of the normal impulse times an arm.
template <class R, int lanes>
PLIANT_HD void resist_rolling(ManifoldRows<lanes>& m, Motion<R>& a, Motion<R>& b) {
  const Vec3<R> spin = b.spin - a.spin, normal = get<R>(m.normal), first = get<R>(m.tangent),
                second = cross(normal, first);
  const R u = dot(spin, first), v = dot(spin, second);
  const R uu = get<R>(m.mobility[1]), vv = get<R>(m.mobility[2]), uv = get<R>(m.mobility[3]);
  const R scale = R(1.f) / max(uu * vv - uv * uv, R(tiny));
  const R before[2] = {get<R>(m.rolling_impulse[0]), get<R>(m.rolling_impulse[1])};
  const R wanted[2] = {before[0] - scale * (vv * u - uv * v), before[1] - scale * (uu * v - uv * u)};
  const R limit = pressing<R>(m) * get<R>(m.rolling);
  const R size = sqrt(wanted[0] * wanted[0] + wanted[1] * wanted[1]);
  const R share = select(size <= limit, R(1.f), limit / max(size, R(tiny)));
  const auto rolls = get<R>(m.rolling) > R(0.f);
  const R after[2] = {select(rolls, wanted[0] * share, before[0]), select(rolls, wanted[1] * share, before[1])};
  store_row(m.rolling_impulse[0], after[0]);
  store_row(m.rolling_impulse[1], after[1]);
  add_moment(m, first * (after[0] - before[0]) + second * (after[1] - before[1]), a, b);
}

/// Applies the kept moments against rolling, at the start of a substep.
template <class R, int lanes>
PLIANT_HD void warm_start_rolling(const ManifoldRows<lanes>& m, Motion<R>& a, Motion<R>& b) {
  const Vec3<R> normal = get<R>(m.normal), first = get<R>(m.tangent);
  add_moment(m, first * get<R>(m.rolling_impulse[0]) + cross(normal, first) * get<R>(m.rolling_impulse[1]), a, b);
}

/// What a point goes for: the velocity -bias, while the share 1 - `kept` of its impulse leaks.
template <class R>
struct Aim {
  R bias, kept, leak;
};

/// A point in a pass: what it goes for, what it opposes to an impulse and had before, and the motion of its unit
/// impulse.
template <class R>
struct PressedPoint {
  Aim<R> aim;
  R mass, before;
  Wrench<R> answer;
};

/// Solves a point alone, and returns the change of its impulse.
template <class R, int lanes>
PLIANT_HD R press_point(const ManifoldRows<lanes>& m, int i, const PressedPoint<R>& point, Wrench<R>& motion) {
  const Aim<R>& aim = point.aim;
  const R wanted = -aim.kept * (at_point(m, i, motion) + aim.bias) * point.mass - aim.leak * point.before;
  const R change = max(point.before + wanted, R(0.f)) - point.before;
  push(point.answer, change, motion);
  return change;
}

/// One pass over the points, one after another, in two orders from the same start: 0 1 2 3 and 2 3 0 1. The mean of
/// both impulses counts: points of a flat contact lie around its centre, so what one order tilts, the other one tilts
/// back. With one order, the fall of a tower of boxes into its contacts leans it, and it sways for minutes.
template <class R, int lanes, class AimOf>
PLIANT_HD void press(ManifoldRows<lanes>& m, Motion<R>& a, Motion<R>& b, const AimOf& aim_of) {
  Wrench<R> motion = along(m, approach(m, a, b), b.spin - a.spin), other = motion;
  const Mobility<R> mobility = mobility_of<R>(m);
  PressedPoint<R> points[4];
  PointImpulses<R> change;
  PLIANT_UNROLL
  for (int i = 0; i < 4; ++i) points[i] = {aim_of(i), get<R>(m.mass[i]), get<R>(m.impulse[i]), answer(m, mobility, i)};
  PLIANT_UNROLL
  for (int k = 0; k < 4; ++k) {
    const int opposite = k ^ 2;
    const R first = press_point(m, k, points[k], motion), second = press_point(m, opposite, points[opposite], other);
    change.at[k] = k < 2 ? first : change.at[k] + first;
    change.at[opposite] = k < 2 ? second : change.at[opposite] + second;
  }
  PLIANT_UNROLL
  for (int i = 0; i < 4; ++i) {
    change.at[i] = change.at[i] * R(0.5f);
    store_row(m.impulse[i], points[i].before + change.at[i]);
  }
  apply(m, change, a, b);
}

/// The separation of each point when bodies have moved since the frame's start.
template <class R, int lanes>
PLIANT_HD Wrench<R> moved_apart(const ManifoldRows<lanes>& m, const Moved<R>& a, const Moved<R>& b) {
  const Vec3<R> apart =
      (b.displacement + cross(b.rotation, get<R>(m.arm_b))) - (a.displacement + cross(a.rotation, get<R>(m.arm_a)));
  return along(m, apart, b.rotation - a.rotation);
}

template <class R, int lanes>
PLIANT_HD void warm_start(const ManifoldRows<lanes>& m, Motion<R>& a, Motion<R>& b) {
  apply(m, impulses_of<R>(m), a, b);
  const Vec3<R> normal = get<R>(m.normal), first = get<R>(m.tangent);
  add(m, first * get<R>(m.friction_impulse[0]) + cross(normal, first) * get<R>(m.friction_impulse[1]),
      normal * get<R>(m.twist_impulse), a, b);
}

template <class R, int lanes>
PLIANT_HD void position_pass(ManifoldRows<lanes>& m, Motion<R>& a, Motion<R>& b, const Moved<R>& moved_a,
                             const Moved<R>& moved_b, const PassNumbers& numbers) {
  rub(m, a, b);
  const Wrench<R> moved = moved_apart(m, moved_a, moved_b);
  press(
      m, a, b, [&](int i) __attribute__((always_inline))->Aim<R> {
        const R gap = get<R>(m.gap[i]) + at_point(m, i, moved);
        store_row(m.gap_now[i], gap);
        const auto open = gap > R(0.f);
        return {select(open, gap * R(numbers.inverse_h), max(gap * R(numbers.beta_h), R(-numbers.fastest))),
                select(open, R(1.f), R(numbers.kept)), select(open, R(0.f), R(numbers.epsilon))};
      });
}

template <class R, int lanes>
PLIANT_HD void velocity_pass(ManifoldRows<lanes>& m, Motion<R>& a, Motion<R>& b, const PassNumbers& numbers) {
  rub(m, a, b);
  press(
      m, a, b, [&](int i) __attribute__((always_inline))->Aim<R> {
        return {max(get<R>(m.gap_now[i]), R(0.f)) * R(numbers.inverse_h), R(1.f), R(0.f)};
      });
}

/// Solves contacts that begin at rest (Manifold::settles) to the end where two passes have left them sliding. A pass of
/// friction gives a body spin that the points then take back, so a cube keeps 0.6 of what gravity adds along an
/// incline. Later substeps start with what the earlier ones found; the first one would let it slip.
template <class R, int lanes>
PLIANT_HD void settle(ManifoldRows<lanes>& m, Motion<R>& a, Motion<R>& b, const PassNumbers& numbers) {
  const R zero(0.f);
  const Vec3<R> normal = get<R>(m.normal);
  const auto speed = [&]() __attribute__((always_inline)) {
    const Vec3<R> velocity = approach(m, a, b), along = velocity - normal * dot(velocity, normal);
    return sqrt(dot(along, along));
  };
  const R asked = get<R>(m.settles), slow = select(speed() > asked * R(clearly_sliding), asked, zero);
  for (int pass = 0; pass < passes_of_settling; ++pass) {
    const R excess = select(slow > zero, max(speed() - slow, zero), zero);
    if (all_zero(excess)) return;
    const auto slides = excess > zero;
    const Motion<R> old_a = a, old_b = b;
    const PointImpulses<R> impulse = impulses_of<R>(m);
    const R friction[2] = {get<R>(m.friction_impulse[0]), get<R>(m.friction_impulse[1])};
    const R twist = get<R>(m.twist_impulse);
    velocity_pass(m, a, b, numbers);
    PLIANT_UNROLL
    for (int i = 0; i < 4; ++i) store_row(m.impulse[i], select(slides, get<R>(m.impulse[i]), impulse.at[i]));
    PLIANT_UNROLL
    for (int i = 0; i < 2; ++i)
      store_row(m.friction_impulse[i], select(slides, get<R>(m.friction_impulse[i]), friction[i]));
    store_row(m.twist_impulse, select(slides, get<R>(m.twist_impulse), twist));
    a.velocity = select(slides, a.velocity, old_a.velocity);
    a.spin = select(slides, a.spin, old_a.spin);
    b.velocity = select(slides, b.velocity, old_b.velocity);
    b.spin = select(slides, b.spin, old_b.spin);
  }
}

/// Friction of an impact, at the centre: stops sliding, inside of a disc of the normal impulse times the coefficient.
template <class R, int lanes>
PLIANT_HD void rub_in_impact(const ManifoldRows<lanes>& m, const R& pressed, Motion<R>& a, Motion<R>& b) {
  const Vec3<R> velocity = approach(m, a, b), first = get<R>(m.tangent), second = cross(get<R>(m.normal), first);
  const R u = dot(velocity, first) - get<R>(m.drift[0]), v = dot(velocity, second) - get<R>(m.drift[1]);
  const R both = get<R>(m.slide[2]);
  const R one = -(get<R>(m.slide[0]) * u + both * v), two = -(get<R>(m.slide[1]) * v + both * u);
  const R limit = get<R>(m.friction) * pressed, size = sqrt(one * one + two * two);
  const R share = select(size <= R(hardly_more) * limit, R(1.f), get<R>(m.sliding));
  const R scale = select(size <= limit, R(1.f), share * limit / max(size, R(tiny)));
  const R none(0.f);
  add(m, first * (one * scale) + second * (two * scale), Vec3<R>{none, none, none}, a, b);
}

/// True where a point would pass through in this substep; those points get the velocity that restitution demands. Their
/// impulses are summed apart from those that press: they act once, and no substep may start with them.
template <class R, int lanes>
PLIANT_HD auto bounce(ManifoldRows<lanes>& m, Motion<R>& a, Motion<R>& b, const Moved<R>& moved_a,
                      const Moved<R>& moved_b, float h, const Vec3f& fall) {
  Wrench<R> motion = along(m, approach(m, a, b), b.spin - a.spin);
  const Wrench<R> moved = moved_apart(m, moved_a, moved_b);
  const Mobility<R> mobility = mobility_of<R>(m);
  const R zero(0.f), restitution = get<R>(m.restitution), slow(-2 * length(fall));
  // Gravity's share of the approach in this substep, where it acts on one of both alone. A body that goes back where it
  // came from leaves the height at which it is with the speed that it had there.
  const Vec3<R> falls{R(fall.x), R(fall.y), R(fall.z)}, none{zero, zero, zero};
  const R together =
      dot(get<R>(m.normal), select(b.inverse_mass > zero, falls, none) - select(a.inverse_mass > zero, falls, none));
  R wanted[4], speeds[4], arrivals[4], most = zero, earliest(never);
  PLIANT_UNROLL
  for (int i = 0; i < 4; ++i) {
    const R speed = at_point(m, i, motion), gap = get<R>(m.gap[i]) + at_point(m, i, moved);
    const R back = select(gap + R(h) * speed < zero, -restitution * (speed - together), zero);
    wanted[i] = select(speed <= slow, back, zero);
    most = max(most, wanted[i]);
    speeds[i] = speed;
    arrivals[i] = select(wanted[i] > zero, max(gap, zero) / max(-speed, R(tiny)), R(never));
    earliest = min(earliest, arrivals[i]);
  }
  const auto closes = most > zero;  // where none does, not even the sign of a zero may change
  if (all_zero(most)) return closes;
  const R late = earliest + R(together_share * h);
  PLIANT_UNROLL
  for (int i = 0; i < 4; ++i) wanted[i] = select(arrivals[i] <= late, wanted[i], zero);
  PointImpulses<R> impulse{{zero, zero, zero, zero}};
  for (int pass = 0; pass < passes_of_impact; ++pass) {
    PLIANT_UNROLL
    for (int i = 0; i < 4; ++i) {
      const R after = max(impulse.at[i] + (wanted[i] - at_point(m, i, motion)) * get<R>(m.mass[i]), zero);
      const R next = select(wanted[i] > zero, after, zero);
      push(answer(m, mobility, i), next - impulse.at[i], motion);
      impulse.at[i] = next;
    }
  }
  // The law of restitution along the impulse, which passes may miss: so no impact adds energy.
  R asked = zero, got = zero;
  PLIANT_UNROLL
  for (int i = 0; i < 4; ++i) {
    asked += impulse.at[i] * (wanted[i] - speeds[i]);
    got += impulse.at[i] * (at_point(m, i, motion) - speeds[i]);
  }
  const R share = select(got > zero, asked / max(got, R(tiny)), R(1.f));
  PLIANT_UNROLL
  for (int i = 0; i < 4; ++i) impulse.at[i] = impulse.at[i] * share;
  Motion<R> after_a = a, after_b = b;
  apply(m, impulse, after_a, after_b);
  const R given = (impulse.at[0] + impulse.at[1]) + (impulse.at[2] + impulse.at[3]);
  rub_in_impact(m, given, after_a, after_b);
  store_row(m.bounced, get<R>(m.bounced) + given);  // none where no point closes
  a.velocity = select(closes, after_a.velocity, a.velocity);
  a.spin = select(closes, after_a.spin, a.spin);
  b.velocity = select(closes, after_b.velocity, b.velocity);
  b.spin = select(closes, after_b.spin, b.spin);
  return closes;
}

/// The mean distance of the touching points (touching_points) from their centre [m].
template <class R, int lanes>
PLIANT_HD R mean_radius(const ManifoldRows<lanes>& m) {
  R nearest = get<R>(m.gap[0]), x = get<R>(m.x[0]), y = get<R>(m.y[0]), sum(0.f), count(0.f);
  PLIANT_UNROLL
  for (int i = 1; i < 4; ++i) {
    const R gap = get<R>(m.gap[i]);
    const auto is_nearer = gap < nearest;
    x = select(is_nearer, get<R>(m.x[i]), x);
    y = select(is_nearer, get<R>(m.y[i]), y);
    nearest = select(is_nearer, gap, nearest);
  }
  PLIANT_UNROLL
  for (int i = 0; i < 4; ++i) {  // the square of the gap of a point that does not exist is infinite
    const R u = get<R>(m.x[i]), v = get<R>(m.y[i]), above = get<R>(m.gap[i]) - nearest;
    const R along = (u - x) * (u - x) + (v - y) * (v - y);
    const auto touches = above * above <= R(touching_slope * touching_slope) * along;
    sum += select(touches, sqrt(u * u + v * v), R(0.f));
    count += select(touches, R(1.f), R(0.f));
  }
  return sum * (R(1.f) / count);
}

/// K = J M^-1 J^T of normal force and moments about tangents, and the masses that follow.
template <class R, int lanes>
PLIANT_HD void prepare(ManifoldRows<lanes>& m, const Motion<R>& a, const Motion<R>& b) {
  const Vec3<R> normal = get<R>(m.normal), first = get<R>(m.tangent), second = cross(normal, first);
  const Vec3<R> arm_a = get<R>(m.arm_a), arm_b = get<R>(m.arm_b), na = cross(arm_a, normal), nb = cross(arm_b, normal);
  const Vec3<R> of_na = turned(a, na), of_nb = turned(b, nb);
  const Vec3<R> of_first = turned(a, first) + turned(b, first), of_second = turned(a, second) + turned(b, second);
  const R inverse_mass = a.inverse_mass + b.inverse_mass, one(1.f), least(tiny);
  const Mobility<R> mobility{{inverse_mass + (dot(na, of_na) + dot(nb, of_nb)), dot(first, of_first),
                              dot(second, of_second), dot(first, of_second), dot(second, of_na + of_nb),
                              dot(first, of_na + of_nb)}};
  PLIANT_UNROLL
  for (int i = 0; i < 6; ++i) store_row(m.mobility[i], mobility.k[i]);
  PLIANT_UNROLL
  for (int i = 0; i < 4; ++i) {
    store_row(m.mass[i], one / max(at_point(m, i, answer(m, mobility, i)), least));
  }
  store_row(m.twist_arm, get<R>(m.friction) * mean_radius<R>(m) + get<R>(m.spinning));
  store_row(m.twist_mass, one / max(dot(normal, turned(a, normal) + turned(b, normal)), least));
  const Vec3<R> ua = cross(arm_a, first), ub = cross(arm_b, first), va = cross(arm_a, second),
                vb = cross(arm_b, second);
  const Vec3<R> of_va = turned(a, va), of_vb = turned(b, vb);
  const R uu = inverse_mass + (dot(ua, turned(a, ua)) + dot(ub, turned(b, ub))),
          vv = inverse_mass + (dot(va, of_va) + dot(vb, of_vb)), uv = dot(ua, of_va) + dot(ub, of_vb);
  const R scale = one / max(uu * vv - uv * uv, least);
  store_row(m.slide[0], vv * scale);
  store_row(m.slide[1], uu * scale);
  store_row(m.slide[2], -uv * scale);
}

}  // namespace pliant::manifold_formulas
