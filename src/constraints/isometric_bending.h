// Bending of a sheet with a flat rest shape that hardly stretches: a quadratic energy, cheap and robust.
//
//         2
//       /   \          C(x) = |k1 (x1 - x0) + k2 (x2 - x0) + k3 (x3 - x0)|
//      0 --- 1
//       \   /          k from the cotangents of the rest angles, times sqrt(3 / (A1 + A2))
//         3
//
// Bergou et al. 2006, "A quadratic bending model for inextensible surfaces", eq. 4, with alpha = 1 / B. A developable
// sheet has flexural rigidity B for alpha = 3 / B (matter/cloth.cpp). The norm is over the discrete mean curvature
// normal, which vanishes for any flat hinge; so this type cannot hold a fold. Compliance in 1/(N m).
#pragma once

#include <array>

#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct IsometricBending {
  static constexpr const char* name = "isometric_bending";
  using slots = Points<4>;
  static constexpr int rows = 1;

  template <class R>
  struct Params {
    R k1, k2, k3;  ///< coefficients of C, from the rest shape [1/m]
  };
  static constexpr std::array<const char*, 3> fields{"k1", "k2", "k3"};

  /// For a flat hinge the gradient is zero, so nothing moves.
  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[4], const Params<R>& p, Vec3<R> (&gradient)[4]) {
    const Vec3<R> sum = (x[1] - x[0]) * p.k1 + (x[2] - x[0]) * p.k2 + (x[3] - x[0]) * p.k3;
    const R c = sqrt(dot(sum, sum));
    const Vec3<R> direction = sum * (R(1) / max(c, R(1e-20f)));
    gradient[1] = direction * p.k1;
    gradient[2] = direction * p.k2;
    gradient[3] = direction * p.k3;
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
    return c;
  }

  /// The cotangent of an angle, clamped to a million: beyond, a triangle is a line, and its squared weight would
  /// overflow.
  template <class R>
  PLIANT_HD static R cotangent(const Vec3<R>& u, const Vec3<R>& v) {
    const Vec3<R> n = cross(u, v);
    const R along = dot(u, v);
    return along / max(max(sqrt(dot(n, n)), abs(along) * R(1e-6f)), R(1e-20f));
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[4]) {
    const Vec3<R> e = x[1] - x[0], a = x[2] - x[0], b = x[3] - x[0];
    const R at0 = cotangent(e, a), at0_other = cotangent(e, b);
    const R at1 = cotangent(-e, x[2] - x[1]), at1_other = cotangent(-e, x[3] - x[1]);
    const Vec3<R> n1 = cross(e, a), n2 = cross(b, e);
    const R area = (sqrt(dot(n1, n1)) + sqrt(dot(n2, n2))) * R(0.5f);
    const R scale = sqrt(R(3) / max(max(area, dot(e, e) * R(1e-6f)), R(1e-20f)));
    return {(at0 + at0_other) * scale, -(at0 + at1) * scale, -(at0_other + at1_other) * scale};
  }
};

}  // namespace pliant
