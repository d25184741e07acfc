// The volume of the tetrahedra around an edge, together.
//
//        r1---r0
//        | .   . |       C(x) = V / V0 - 1,   V = sum of (b - a) . ((r_i - a) x (r_k - a)) / 6 over the tetrahedra (a, b, r_i, r_k)
//       r2   ab   r5
//        | .   . |       seen along the edge from a to b. The ring of `ring` points, 2 to 6, is open between its last and its
//        r3---r4         first point, or closed by one tetrahedron more.
//
// Tetrahedra that each keep their volume (TetrahedronVolume) have two constraints for each three directions in which a
// particle can move, so a body that hardly changes its volume hardly bends, too. Around edges there is about one for
// each particle. In a grid of six tetrahedra a cell these are the cells, which is the hexahedron of constant pressure
// (Nagtegaal, Parks and Rice 1974). With alpha = 1 / (lambda V0) it is the volumetric part of a neo-Hookean solid.
// Points of the ring that are not there repeat a. Compliance in 1/J.
#pragma once

#include <array>

#include "math/unroll.h"
#include "math/vector.h"
#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct VolumeAroundEdge {
  static constexpr const char* name = "volume_around_edge";
  static constexpr bool is_of_solid = true;
  using slots = Points<8>;  ///< r0 to r5, a, b: the ends of the edge last, since their corrections are stored last
  static constexpr int rows = 1;
  static constexpr int most_ring = 6;

  template <class R>
  struct Params {
    R rest_volume;  ///< V0 [m^3]
    R ring;         ///< points of the ring
    R closes;       ///< 1: the ring is closed; 0: open
  };
  static constexpr std::array<const char*, 3> fields{"rest_volume", "ring", "closes"};

  /// A rest volume of 0 makes C and the gradients 0.
  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[8], const Params<R>& p, Vec3<R> (&gradient)[8]) {
    const R zero(0), one(1);
    const auto is_solid = abs(p.rest_volume) > zero;
    const R active = select(is_solid, one, zero);
    const R scale = active / (R(6) * select(is_solid, p.rest_volume, one));
    const Vec3<R> none{zero, zero, zero}, edge = x[7] - x[6];
    Vec3<R> arm[most_ring], last = none, of_b = none;
    PLIANT_UNROLL
    for (int i = 0; i < most_ring; ++i) {
      arm[i] = x[i] - x[6];
      gradient[i] = none;
      last = select(p.ring == R(float(i + 1)), arm[i], last);
    }
    PLIANT_UNROLL
    for (int i = 0; i + 1 < most_ring; ++i) {
      const R share = select(p.ring > R(float(i + 1)), scale, zero);
      gradient[i] += cross(arm[i + 1], edge) * share;
      gradient[i + 1] += cross(edge, arm[i]) * share;
      of_b += cross(arm[i], arm[i + 1]) * share;
    }
    const R closing = p.closes * scale;
    const Vec3<R> of_last = cross(arm[0], edge) * closing;
    gradient[0] += cross(edge, last) * closing;
    of_b += cross(last, arm[0]) * closing;
    gradient[6] = none;
    PLIANT_UNROLL
    for (int i = 0; i < most_ring; ++i) {
      gradient[i] = gradient[i] + select(p.ring == R(float(i + 1)), of_last, none);
      gradient[6] = gradient[6] - gradient[i];
    }
    gradient[6] = gradient[6] - of_b;
    gradient[7] = of_b;
    return dot(edge, of_b) - active;
  }

  /// The rest volume of a closed ring of six points.
  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[8]) {
    Vec3<R> gradient[8];
    const Params<R> closed{R(1) / R(6), R(most_ring), R(1)};
    return {(evaluate(x, closed, gradient) + R(1)) / R(6), closed.ring, closed.closes};
  }
};

}  // namespace pliant
