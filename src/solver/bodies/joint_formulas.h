// What the solution of joint trees computes for each body and joint, written once: F is float for one tree, Wide for
// sixteen side by side.
#pragma once

#include "math/quat.h"
#include "math/scalar.h"
#include "math/vector.h"

namespace pliant::joint_formulas {

/// A gap [m] or angle [rad] below this is closed.
inline constexpr float least_gap = 1e-6f;
/// A joint with compliance is open if it is off by this share of its arms.
inline constexpr float open_share_of_soft = 1e-3f;

/// The inertia of a body in world axes and its inverse (xx, yy, zz, yz, zx, xy), from the inverses of its principal
/// moments.
template <class F>
PLIANT_HD void turned_inertia(const Quat<F>& q, const Vec3<F>& of, F (&inertia)[6], F (&inverse)[6]) {
  const F zero(0.f), one(1.f);
  const Vec3<F> axes[3] = {rotate(q, Vec3<F>{one, zero, zero}), rotate(q, Vec3<F>{zero, one, zero}),
                           rotate(q, Vec3<F>{zero, zero, one})};
  const F moments[3] = {one / of.x, one / of.y, one / of.z}, inverses[3] = {of.x, of.y, of.z};
  for (int i = 0; i < 6; ++i) inertia[i] = inverse[i] = zero;
  for (int k = 0; k < 3; ++k) {
    const Vec3<F>& u = axes[k];
    const F products[6] = {u.x * u.x, u.y * u.y, u.z * u.z, u.y * u.z, u.z * u.x, u.x * u.y};
    for (int i = 0; i < 6; ++i) {
      inertia[i] = inertia[i] + products[i] * moments[k];
      inverse[i] = inverse[i] + products[i] * inverses[k];
    }
  }
}

/// Adds the stiffness against rotation that force f at arm r gives a body: (f.r + |f||r|) / 2 - (f r^T + r f^T) / 2,
/// which is never negative. Returns |f||r|.
template <class F>
PLIANT_HD F add_stiffness(const Vec3<F>& f, const Vec3<F>& r, F* sum) {
  const F size = sqrt(length_squared(f) * length_squared(r)), half = (dot(f, r) + size) * F(0.5f), less(-0.5f);
  const F terms[6] = {half - f.x * r.x,
                      half - f.y * r.y,
                      half - f.z * r.z,
                      (f.y * r.z + f.z * r.y) * less,
                      (f.z * r.x + f.x * r.z) * less,
                      (f.x * r.y + f.y * r.x) * less};
  for (int i = 0; i < 6; ++i) sum[i] = sum[i] + terms[i];
  return size;
}

/// An orientation after a small rotation vector in world axes [rad].
template <class F>
PLIANT_HD Quat<F> turned(const Quat<F>& q, const Vec3<F>& theta) {
  const F half(0.5f);
  const Quat<F> spin = multiply(Quat<F>{theta.x, theta.y, theta.z, F(0.f)}, q);
  return normalise(Quat<F>{q.x + half * spin.x, q.y + half * spin.y, q.z + half * spin.z, q.w + half * spin.w});
}

}  // namespace pliant::joint_formulas
