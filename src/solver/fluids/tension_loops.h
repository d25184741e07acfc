// The passes over a group of sixteen slots in sixteen lanes, or over its slots one at a time: tension_lanes.cpp and
// tension_sequential.cpp say how lanes are loaded.
#pragma once

#include "math/vector.h"
#include "math/wide.h"
#include "solver/fluids/tension_kernels.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace tension_formulas {

using pliant::max;  // of floats, which that of lanes hides

/// `Lanes` has the type of a value, how many slots it holds, and how it loads and stores them.
template <class Lanes, class Unit>
struct Loops {
  using R = typename Lanes::Value;

  /// 1 - r^2 / reach^2 of a neighbour at -d, or 0.
  static R nearness(const TensionLaw& law, const Vec3<R>& d) {
    const R inverse(1 / law.reach);
    const R x = d.x * inverse, y = d.y * inverse, z = d.z * inverse;
    return max(R(1.f) - (x * x + y * y + z * z), R(0.f));
  }

  static void count(const TensionArrays& a, const NeighbourGroup& group, int number) {
    for (int lane = 0; lane < neighbour_lanes; lane += Lanes::count) {
      const int slot = number * neighbour_lanes + lane;
      const Vec3<R> place = Lanes::load_own(a.places + slot).position;
      R sum(0.f);
      for (int k = 0; k < group.rows; ++k) {
        const R u = nearness(a.law, place - Lanes::load(a.places, group.slots + k * neighbour_lanes + lane).position);
        sum = sum + u * u;
      }
      R found = R(a.law.own) + R(a.law.count_scale) * sum;
      if (a.walls != nullptr) found = found + Lanes::load(a.walls + slot);
      const R lack = max(R(a.law.full) - found, R(0.f));
      Lanes::store_own(a.lacking + slot, place, R(a.law.energy) * Lanes::load(a.tensions + slot) * lack);
    }
  }

  static void pull(const TensionArrays& a, const NeighbourGroup& group, int number) {
    for (int lane = 0; lane < neighbour_lanes; lane += Lanes::count) {
      const int slot = number * neighbour_lanes + lane;
      const auto own = Lanes::load_own(a.lacking + slot);
      const R zero(0.f);
      Vec3<R> sum{zero, zero, zero};
      for (int k = 0; k < group.rows; ++k) {
        const auto other = Lanes::load(a.lacking, group.slots + k * neighbour_lanes + lane);
        const Vec3<R> d = own.position - other.position;
        const R by = (own.w + other.w) * nearness(a.law, d);
        sum = {sum.x + by * d.x, sum.y + by * d.y, sum.z + by * d.z};
      }
      const R scale(-a.law.gradient_scale);
      Lanes::store_own(a.forces + slot, {scale * sum.x, scale * sum.y, scale * sum.z}, zero);
    }
  }

  static const TensionKernels table;
};

template <class Lanes, class Unit>
const TensionKernels Loops<Lanes, Unit>::table{count, pull};

}  // namespace tension_formulas
}  // namespace PLIANT_ISA
}  // namespace pliant
