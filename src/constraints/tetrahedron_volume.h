// The volume of a tetrahedron.
//
//          3
//         /|\          C(x) = (x1 - x0) x (x2 - x0) . (x3 - x0) / (6 V0) - 1
//        0-+-2
//         \|/
//          1
//
// Mueller et al. 2007, section 4.4.2, divided by the rest volume V0; with alpha = 1 / (lambda V0) it is the volumetric
// part of a neo-Hookean solid (Macklin and Mueller 2021, "A constraint-based formulation of stable neo-Hookean
// materials"). C keeps its sign when the tetrahedron is turned inside out, so the constraint turns it back. Compliance
// in 1/J.
#pragma once

#include <array>

#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct TetrahedronVolume {
  static constexpr const char* name = "tetrahedron_volume";
  static constexpr bool is_of_solid = true;
  using slots = Points<4>;
  static constexpr int rows = 1;
  static constexpr bool rest_scales = true;

  template <class R>
  struct Params {
    R rest_volume;  ///< V0; negative for corners in the other order [m^3]
  };
  static constexpr std::array<const char*, 1> fields{"rest_volume"};

  /// A rest volume of 0 makes C and the gradients 0.
  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[4], const Params<R>& p, Vec3<R> (&gradient)[4]) {
    const Vec3<R> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const auto is_solid = abs(p.rest_volume) > R(0);
    const R active = select(is_solid, R(1), R(0));
    const R scale = R(1) / (R(6) * select(is_solid, p.rest_volume, R(1)));
    gradient[1] = cross(b, c) * (scale * active);
    gradient[2] = cross(c, a) * (scale * active);
    gradient[3] = cross(a, b) * (scale * active);
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
    return dot(gradient[1], a) - active;
  }

  /// The rest volume; 0 if it is below a millionth of the product of the edges at the first corner.
  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[4]) {
    const Vec3<R> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const R six = dot(cross(a, b), c);
    const R edges = sqrt(dot(a, a)) * sqrt(dot(b, b)) * sqrt(dot(c, c));
    return {select(abs(six) > edges * R(1e-6f), six / R(6), R(0))};
  }
};

}  // namespace pliant
