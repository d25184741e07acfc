// A fibre in a tetrahedron: a muscle, or what stiffens a solid along one direction.
//
//          3
//         /|\          C(x) = |f| - s,   f = a1 (x1 - x0) + a2 (x2 - x0) + a3 (x3 - x0)
//        0-+-2
//         \|/          f = F d: where the deformation takes a unit vector d of the rest shape, so |f| is the stretch
//          1
//
// With alpha = 1 / (E V0), C^2 / (2 alpha) is the energy of a volume V0 of fibres of modulus E whose rest stretch is s:
// 1 when passive, less when a muscle contracts. f = 0 has no direction: nothing moves then. Compliance in 1/J.
#pragma once

#include <array>

#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct Fibre {
  static constexpr const char* name = "fibre";
  using slots = Points<4>;
  static constexpr int rows = 1;
  static constexpr bool rest_scales = true;

  template <class R>
  struct Params {
    R stretch;     ///< s [-]
    R a1, a2, a3;  ///< D^-1 d, where D has the three edges at rest as columns [1/m]
  };
  static constexpr std::array<const char*, 4> fields{"stretch", "a1", "a2", "a3"};

  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[4], const Params<R>& p, Vec3<R> (&gradient)[4]) {
    const Vec3<R> f = (x[1] - x[0]) * p.a1 + (x[2] - x[0]) * p.a2 + (x[3] - x[0]) * p.a3;
    const R length = sqrt(dot(f, f));
    const Vec3<R> along = f * (R(1) / max(length, R(1e-20f)));
    gradient[1] = along * p.a1;
    gradient[2] = along * p.a2;
    gradient[3] = along * p.a3;
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
    return length - p.stretch;
  }

  /// A fibre along the edge from corner 0 to corner 1; none, so that nothing moves, if that has no length.
  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[4]) {
    const Vec3<R> d = x[1] - x[0];
    const R length = sqrt(dot(d, d));
    const auto has_length = length > R(0);
    const R one = select(has_length, R(1), R(0));
    return {one, one / select(has_length, length, R(1)), R(0), R(0)};
  }
};

}  // namespace pliant
