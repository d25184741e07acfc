// Stretching: two particles keep their distance.
//
//     0 -------- 1        C(x) = |x1 - x0| - L
//
// Mueller et al. 2007, section 4.1; with compliance Macklin et al. 2016, eq. 18. Compliance in m/N.
#pragma once

#include <array>
#include <utility>

#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct Distance {
  static constexpr const char* name = "distance";
  using slots = Points<2>;
  static constexpr int rows = 1;
  /// Gradients have length one unless they vanish, so the driver need not compute their norms.
  static constexpr bool unit_gradients = true;
  /// C is the distance of two points minus rest field 0. Chains, tethers, multigrid and stretch measures require this.
  static constexpr bool is_length = true;
  static constexpr bool rest_scales = true;

  template <class R>
  struct Params {
    R rest_length;  ///< rest length [m]
  };
  static constexpr std::array<const char*, 1> fields{"rest_length"};

  /// For coincident points the gradient is zero, so nothing moves.
  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[2], const Params<R>& p, Vec3<R> (&gradient)[2]) {
    const Vec3<R> d = x[1] - x[0];
    const R length = sqrt(dot(d, d));
    gradient[1] = d * (R(1) / max(length, R(1e-20f)));
    gradient[0] = -gradient[1];
    return length - p.rest_length;
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[2]) {
    const Vec3<R> d = x[1] - x[0];
    return {sqrt(dot(d, d))};
  }

  /// Orders the two points ascending, so that neighbouring constraints have similar stencils.
  static void canonical(std::array<int, 2>& particle, Params<float>&) {
    if (particle[0] > particle[1]) std::swap(particle[0], particle[1]);
  }
};

}  // namespace pliant
