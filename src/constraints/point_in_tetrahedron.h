// A particle stays at a place in a tetrahedron, as a tendon in flesh does.
//   C_k = e_k . (x0 - (1 - b - c - d) x1 - b x2 - c x3 - d x4), e_k the world's axes.   Compliance in m/N.
#pragma once

#include <array>

#include "constraints/weighted_place.h"
#include "pliant/formula.h"

namespace pliant {

struct PointInTetrahedron {
  static constexpr const char* name = "point_in_tetrahedron";
  using slots = Points<5>;  // particle, corners of the tetrahedron
  static constexpr int rows = 3;

  template <class R>
  struct Params {
    R b, c, d;  ///< weights of the second to the fourth corner [-]
  };
  static constexpr std::array<const char*, 3> fields{"weight_b", "weight_c", "weight_d"};

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const R weights[5] = {R(1), p.b + p.c + p.d - R(1), -p.b, -p.c, -p.d};
    evaluate_weighted_place(at, weights, out);
  }

  /// The particle's place, which may be outside of the tetrahedron; the first corner if that is flat.
  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[5]) {
    const Vec3<R> u = x[2] - x[1], v = x[3] - x[1], w = x[4] - x[1], at = x[0] - x[1];
    const R six = dot(cross(u, v), w);
    const R edges = sqrt(dot(u, u)) * sqrt(dot(v, v)) * sqrt(dot(w, w));
    const auto is_solid = abs(six) > edges * R(1e-6f);
    const R scale = select(is_solid, R(1) / select(is_solid, six, R(1)), R(0));
    return {dot(cross(v, w), at) * scale, dot(cross(w, u), at) * scale, dot(cross(u, v), at) * scale};
  }
};

}  // namespace pliant
