// A limit on stretching: two particles stay between two distances, and are free between them.
//
//     0 -------- 1        C(x) = d - min(max(d, shortest), longest),   d = |x1 - x0|
//
// Provot 1995, section 4, limits the edges of cloth so. Compliance in m/N, for what is beyond the limits.
#pragma once

#include <array>
#include <utility>

#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct DistanceLimit {
  static constexpr const char* name = "distance_limit";
  using slots = Points<2>;
  static constexpr int rows = 1;
  static constexpr bool unit_gradients = true;
  static constexpr bool rest_scales = true;

  template <class R>
  struct Params {
    R longest, shortest;  ///< [m]
  };
  static constexpr std::array<const char*, 2> fields{"longest", "shortest"};

  /// Between the limits, and for coincident points, C and the gradient are such that nothing moves.
  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[2], const Params<R>& p, Vec3<R> (&gradient)[2]) {
    const Vec3<R> d = x[1] - x[0];
    const R length = sqrt(dot(d, d));
    const R acts = select(length < p.shortest, R(1), select(p.longest < length, R(1), R(0)));
    gradient[1] = d * (acts / max(length, R(1e-20f)));
    gradient[0] = -gradient[1];
    return length - min(max(length, p.shortest), p.longest);
  }

  /// No longer than now.
  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[2]) {
    const Vec3<R> d = x[1] - x[0];
    return {sqrt(dot(d, d)), R(0)};
  }

  static void canonical(std::array<int, 2>& particle, Params<float>&) {
    if (particle[0] > particle[1]) std::swap(particle[0], particle[1]);
  }
};

}  // namespace pliant
