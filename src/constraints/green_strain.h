// Green's strain of a tetrahedron: a St. Venant-Kirchhoff solid.
//
//          3
//         /|\          C(x) = sqrt(2) |E|  and  C(x) = tr E,   E = (F^T F - 1) / 2
//        0-+-2
//         \|/          F as in tetrahedron_strain.h
//          1
//
// With alpha = 1 / (mu V0) for the first and alpha = 1 / (lambda V0) for the second, C^2 / (2 alpha) together are the
// energy V0 (mu |E|^2 + lambda / 2 (tr E)^2). Strains as in Hooke's law, for any rotation. A bar that is pressed below
// 1 / sqrt(3) = 0.58 of its length gets softer, and what is inverted or pressed flat may stay so: E is the same for it.
// Compliance in 1/J.
#pragma once

#include "constraints/tetrahedron_strain.h"

namespace pliant {

struct GreenStrain : TetrahedronStrain {
  static constexpr const char* name = "green_strain";
  static constexpr bool is_of_solid = true;
  static constexpr bool is_arithmetic = true;
  /// Largest change of F in one projection, as a share of |F| or of 1, by which C is held. It matters alone where a
  /// tetrahedron that is not stretched is pressed nearly flat, to a twentieth: the gradient vanishes there, and C does
  /// not.
  static constexpr float most_step = 8;

  /// C is zero without a direction at rest; the gradients are then zero.
  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[4], const Params<R>& p, Vec3<R> (&gradient)[4]) {
    ByColumns<R> of_f;
    const R value = evaluate_at(deformation(x, p), p, of_f);
    to_corners(of_f, p, gradient);
    return value;
  }

  /// C and dC/dF of F.
  template <class R>
  PLIANT_HD static R evaluate_at(const ByColumns<R>& f, const Params<R>& p, ByColumns<R>& gradient) {
    const SymmetricTensor<R> e = green_strain(f);
    const R value = select(is_solid(p), sqrt(R(2) * e.squares()), R(0)), share = held(f);
    const R scale = share * R(2) / max(value, R(1e-7f));
    const ByColumns<R> g = f.times(e);
    gradient = g * scale;
    return min(value * share, R(most_step) * sqrt(max(f.squares(), R(1)) * g.squares()) * scale);
  }
};

struct GreenTrace : TetrahedronStrain {
  static constexpr const char* name = "green_trace";
  static constexpr bool is_length_of_strain = false;
  static constexpr bool is_of_solid = true;
  static constexpr bool is_arithmetic = true;

  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[4], const Params<R>& p, Vec3<R> (&gradient)[4]) {
    const ByColumns<R> f = deformation(x, p);
    const R scale = held(f);
    to_corners({f.x * scale, f.y * scale, f.z * scale}, p, gradient);
    return select(is_solid(p), green_strain(f).trace() * scale, R(0));
  }
};

}  // namespace pliant
