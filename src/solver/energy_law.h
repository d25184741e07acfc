// Integrator::energy: an elastic force is that of a mean of three times, so that motion is kept.
//
// With the force of the substep's end alone (implicit Euler) a mode of frequency omega loses a share of (omega h)^2 /
// 2 of its amplitude in a substep. Here C is replaced by
//
//   C^ = a C(x) + b C(x0) + c C(x0 - h v0),   a = 0.2525, b = 0.5, c = 0.2475
//
// x0 and v0 being those of the substep's start. With a = c this is Newmark's average acceleration written for
// positions (Newmark 1959; Geradin and Rixen): unconditionally stable, second order, without dissipation. a - c =
// 0.005 takes (a - c) (omega h)^2 / 2 instead: of what oscillates with the substep itself, 1 % per substep. Velocities
// stay (x - x0) / h, so contact, friction and rigid constraints are as they were. The changes of C are found along its
// gradient: C(x0) = C(x) - grad C . (x - x0), and so on, so forces are central and a body that turns by phi in a
// substep seems shorter by 0.75 phi^2.
//
// A sweep that has not converged is no symmetric operator, and its errors would grow; so would those of the linear
// solve of a tree of joints, whose bodies turn. So the mean fades into the end where a constraint is stiff for the
// substep, that is where w = sum w_i |grad C|^2 is above `most` alpha / h^2. A rigid one has the force of the end.
// docs/internals/integrator.md has the figures.
#pragma once

#include "math/scalar.h"

namespace pliant::energy_law {

inline constexpr float weight_of_end = 0.2525f, weight_of_before = 0.2475f;

/// What is subtracted from C: `motion` times the change of C in the substep, and `coast` times that in an h before it.
template <class R>
struct Shares {
  R motion, coast;
};

/// The shares of a constraint of this compliance over h^2, whose inverse mass is `mass`. `most` times the compliance
/// is the inverse mass up to which the mean is whole.
template <class R>
PLIANT_HD Shares<R> shares_of(const R& compliance, const R& mass, const R& most) {
  const R whole = min(R(1.f), compliance * most / max(mass, R(1e-20f)));
  return {whole * R(1 - weight_of_end), whole * R(weight_of_before)};
}

inline constexpr float most_of_sweep = 2;  ///< `most` of sweeps

/// `most` of a row of a tree of joints: of those that bend and twist, and of those that also move bodies, as the
/// stretch of rods does. `moves` is the square of the gradient at a body's centre.
template <class R>
PLIANT_HD R most_of_tree(const R& moves) {
  return select(moves > R(0.f), R(1.f), R(1000.f));
}

}  // namespace pliant::energy_law
