// The stretch of a triangle along a direction of its rest shape: the warp or weft of woven cloth.
//
//        2
//       / \           C(x) = |f| - s,   f = a1 (x1 - x0) + a2 (x2 - x0)
//      /   \          f = F d: where the deformation takes a unit vector d of the rest shape, so |f| is the stretch
//     0-----1
//
// The stretch condition of Baraff and Witkin 1998 (4.2), here by XPBD. With alpha = 1 / (Y A), C^2 / (2 alpha) is the
// energy of an area A of parallel yarns of modulus Y [N/m]. f = 0 has no direction: nothing moves then. Compliance in
// 1/J.
#pragma once

#include <array>

#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct TriangleStretch {
  static constexpr const char* name = "triangle_stretch";
  using slots = Points<3>;
  static constexpr int rows = 1;
  static constexpr bool is_of_woven = true;
  static constexpr bool rest_scales = true;

  template <class R>
  struct Params {
    R stretch;  ///< s [-]
    R a1, a2;   ///< D^-1 d, where D has the two edges at rest as columns, in the plane of the triangle [1/m]
  };
  static constexpr std::array<const char*, 3> fields{"stretch", "a1", "a2"};

  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[3], const Params<R>& p, Vec3<R> (&gradient)[3]) {
    const Vec3<R> f = (x[1] - x[0]) * p.a1 + (x[2] - x[0]) * p.a2;
    const R length = sqrt(dot(f, f));
    const Vec3<R> along = f * (R(1) / max(length, R(1e-20f)));
    gradient[1] = along * p.a1;
    gradient[2] = along * p.a2;
    gradient[0] = -(gradient[1] + gradient[2]);
    return length - p.stretch;
  }

  /// Along the edge from corner 0 to corner 1; nothing moves if that has no length.
  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[3]) {
    const Vec3<R> d = x[1] - x[0];
    const R length = sqrt(dot(d, d));
    const auto has_length = length > R(0);
    const R one = select(has_length, R(1), R(0));
    return {one, one / select(has_length, length, R(1)), R(0)};
  }
};

}  // namespace pliant
