// The passes over a group of sixteen slots in sixteen lanes, or over its slots one at a time: viscosity_lanes.cpp and
// viscosity_sequential.cpp say how lanes are loaded.
#pragma once

#include "math/inverse_root.h"
#include "math/vector.h"
#include "math/wide.h"
#include "solver/fluids/viscosity_kernels.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace viscosity_formulas {

using pliant::inverse_root, pliant::max;  // of floats, which those of lanes hide

/// `Lanes` has the type of a value, how many slots it holds, and how it loads and stores them.
template <class Lanes, class Unit>
struct Loops {
  using R = typename Lanes::Value;

  /// The harmonic mean: what layers of both, one behind the other, have.
  static R mean(const R& a, const R& b) { return R(2.f) * a * b / max(a + b, R(1e-30f)); }

  static void find_factors(const ViscosityArrays& a, const NeighbourGroup& group, int number) {
    for (int lane = 0; lane < neighbour_lanes; lane += Lanes::count) {
      const int slot = number * neighbour_lanes + lane;
      const auto own = Lanes::load_own(a.places + slot);
      const R own_viscosity = a.viscosities == nullptr ? R(0.f) : Lanes::load(a.viscosities + slot);
      for (int k = 0; k < group.rows; ++k) {
        const std::int32_t* slots = group.slots + k * neighbour_lanes + lane;
        const Vec3<R> d = own.position - Lanes::load(a.places, slots).position;
        const R r2 = max(d.x * d.x + d.y * d.y + d.z * d.z, R(1e-12f));
        const R inverse = inverse_root(r2);
        const R q = max(R(a.law.reach) - r2 * inverse, R(0.f));
        R factor = R(a.scale) * (q * (R(a.law.near) + R(a.law.far) * q)) * (inverse * inverse);
        if (a.viscosities != nullptr) factor = factor * mean(own_viscosity, Lanes::load_indexed(a.viscosities, slots));
        Lanes::store(group.factors + k * neighbour_lanes + lane, factor);
      }
    }
  }

  static void resist(const ViscosityArrays& a, const NeighbourGroup& group, int number) {
    for (int lane = 0; lane < neighbour_lanes; lane += Lanes::count) {
      const int slot = number * neighbour_lanes + lane;
      const Vec3<R> place = Lanes::load_own(a.places + slot).position,
                    motion = Lanes::load_own(a.motions + slot).position;
      const R zero(0.f);
      Vec3<R> sum{zero, zero, zero};
      for (int k = 0; k < group.rows; ++k) {
        const std::int32_t* slots = group.slots + k * neighbour_lanes + lane;
        const Vec3<R> d = place - Lanes::load(a.places, slots).position;
        const Vec3<R> v = motion - Lanes::load(a.motions, slots).position;
        const R by = Lanes::load(group.factors + k * neighbour_lanes + lane) * (d.x * v.x + d.y * v.y + d.z * v.z);
        sum = {sum.x + by * d.x, sum.y + by * d.y, sum.z + by * d.z};
      }
      Lanes::store_own(a.forces + slot, sum, zero);
    }
  }

  static const ViscosityKernels table;
};

template <class Lanes, class Unit>
const ViscosityKernels Loops<Lanes, Unit>::table{find_factors, resist};

}  // namespace viscosity_formulas
}  // namespace PLIANT_ISA
}  // namespace pliant
