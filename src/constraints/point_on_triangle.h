// A particle stays at a place on a triangle, as a button on a shirt does.
//   C_k = e_k . (x0 - (1 - b - c) x1 - b x2 - c x3), e_k the world's axes.   Compliance in m/N.
#pragma once

#include <array>

#include "constraints/weighted_place.h"
#include "pliant/formula.h"

namespace pliant {

struct PointOnTriangle {
  static constexpr const char* name = "point_on_triangle";
  using slots = Points<4>;  // particle, corners of the triangle
  static constexpr int rows = 3;

  template <class R>
  struct Params {
    R b, c;  ///< weights of the second and the third corner [-]
  };
  static constexpr std::array<const char*, 2> fields{"weight_b", "weight_c"};

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const R weights[4] = {R(1), p.b + p.c - R(1), -p.b, -p.c};
    evaluate_weighted_place(at, weights, out);
  }

  /// The place in the triangle's plane that is nearest to the particle; the first corner if the triangle has no area.
  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[4]) {
    const Vec3<R> u = x[2] - x[1], v = x[3] - x[1], d = x[0] - x[1];
    const R uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), area = uu * vv - uv * uv;
    const auto has_area = area > uu * vv * R(1e-12f);
    const R scale = select(has_area, R(1) / select(has_area, area, R(1)), R(0));
    return {(dot(u, d) * vv - dot(v, d) * uv) * scale, (dot(v, d) * uu - dot(u, d) * uv) * scale};
  }
};

}  // namespace pliant
