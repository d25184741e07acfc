// The passes over a group of sixteen slots in sixteen lanes, or over its slots one at a time: fluid_lanes.cpp and
// fluid_sequential.cpp say how lanes are loaded.
#pragma once

#include "solver/fluids/fluid_formulas.h"
#include "solver/fluids/fluid_kernels.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace fluid_formulas {

/// `Lanes` has the type of a value, how many slots it holds, and how it loads and stores them.
template <class Lanes, class Unit>
struct Loops {
  using R = typename Lanes::Value;

  static void find_multipliers(const FluidArrays& a, const NeighbourGroup& group, int number) {
    for (int lane = 0; lane < neighbour_lanes; lane += Lanes::count) {
      const int slot = number * neighbour_lanes + lane;
      const auto own = Lanes::load_own(a.places + slot);
      Sums<R> sums;
      for (int k = 0; k < group.rows; ++k) {
        const auto other = Lanes::load(a.places, group.slots + k * neighbour_lanes + lane);
        add_neighbour(own.position - other.position, R(a.law.reach), sums);
      }
      R wall(0.f);
      Vec3<R> gradient{wall, wall, wall};
      if (a.has_walls[number] != 0) {
        const auto of_walls = Lanes::load_own(a.walls + slot);
        wall = of_walls.w;
        gradient = of_walls.position;
      }
      const R least = R(a.law.least_sum) + (a.squares == nullptr ? R(0.f) : Lanes::load(a.squares + slot));
      const R multiplier = Lanes::load(a.multipliers + slot);
      const Solved<R> solved = solve(a.law, a.relaxation, a.softness, sums, wall, gradient, least, multiplier);
      Lanes::store(a.multipliers + slot, multiplier + solved.change);
      Lanes::store(a.densities + slot, solved.density);
      Lanes::store_own(a.weighted + slot, own.position, solved.change);
    }
  }

  static void move(const FluidArrays& a, const NeighbourGroup& group, int number) {
    for (int lane = 0; lane < neighbour_lanes; lane += Lanes::count) {
      const int slot = number * neighbour_lanes + lane;
      const auto own = Lanes::load_own(a.weighted + slot);
      const R zero(0.f);
      Vec3<R> sum{zero, zero, zero};
      for (int k = 0; k < group.rows; ++k) {
        const auto other = Lanes::load(a.weighted, group.slots + k * neighbour_lanes + lane);
        const Vec3<R> d = own.position - other.position;
        // Made again: to keep it would take as much memory as the lists, which is slower where they exceed the cache.
        const R by = (own.w + other.w) * Kernel<R>(d, R(a.law.reach)).factor;
        sum = {sum.x + by * d.x, sum.y + by * d.y, sum.z + by * d.z};
      }
      const R scale(-a.law.gradient_scale);
      Vec3<R> way{scale * sum.x, scale * sum.y, scale * sum.z};
      if (a.has_walls[number] != 0) {
        const auto walls = Lanes::load_own(a.walls + slot);
        way = {way.x + own.w * walls.position.x, way.y + own.w * walls.position.y, way.z + own.w * walls.position.z};
      }
      if (a.lightness != nullptr) {
        const R share = Lanes::load(a.lightness + slot);
        way = {share * way.x, share * way.y, share * way.z};
      }
      Lanes::add(a, slot, way);
    }
  }

  static void measure_walls(const WallQuery& q) {
    for (int lane = 0; lane < neighbour_lanes; lane += Lanes::count) {
      const auto own = Lanes::load_own(q.places + lane);
      R share[most_walls];
      Vec3<R> slope[most_walls];
      R left(1.f);
      for (int i = 0; i < q.count; ++i) {
        const R distance = distance_to(q.walls[i], own.position, slope[i]), zero(0.f);
        const R t = R(1.f) - max(distance, zero) / R(q.law.reach);
        const auto is_near = distance < R(q.law.reach);
        share[i] = select(is_near, R(q.law.wall_scale) * share_behind_plane(t), zero);
        const R size = R(q.law.wall_scale) * slope_behind_plane(t) / R(q.law.reach);
        slope[i] = {select(is_near, slope[i].x * size, zero), select(is_near, slope[i].y * size, zero),
                    select(is_near, slope[i].z * size, zero)};
        left = left * (R(1.f) - share[i]);
        if (q.walls[i].touched != nullptr) *q.walls[i].touched += Lanes::number_of(is_near);
      }
      const Vec3<R> gradient = sum_gradients(q, share, slope, lane);
      Lanes::store_own(q.shares + lane, gradient, R(1.f) - left);
    }
  }

  /// The distance to a wall, and its normal in world axes.
  static R distance_to(const Wall& wall, const Vec3<R>& place, Vec3<R>& normal) {
    const Pose<R> pose{
        {R(wall.pose.position.x), R(wall.pose.position.y), R(wall.pose.position.z)},
        {R(wall.pose.rotation.x), R(wall.pose.rotation.y), R(wall.pose.rotation.z), R(wall.pose.rotation.w)}};
    const SurfaceDistance<R> to = signed_distance(wall.shape, to_local(pose, place));
    normal = rotate(pose.rotation, to.normal);
    return to.distance - R(wall.thickness);
  }

  /// The gradient of 1 - product of (1 - share).
  static Vec3<R> sum_gradients(const WallQuery& q, const R* share, const Vec3<R>* slope, int lane) {
    Vec3<R> sum{R(0.f), R(0.f), R(0.f)};
    for (int wall = 0; wall < q.count; ++wall) {
      R others(1.f);
      for (int i = 0; i < q.count; ++i)
        if (i != wall) others = others * (R(1.f) - share[i]);
      const Vec3<R> gradient{slope[wall].x * others, slope[wall].y * others, slope[wall].z * others};
      sum = {sum.x + gradient.x, sum.y + gradient.y, sum.z + gradient.z};
      if (q.walls[wall].gradients != nullptr) Lanes::store_vectors(q.walls[wall].gradients + lane, gradient);
    }
    return sum;
  }

  static const FluidKernels table;
};

template <class Lanes, class Unit>
const FluidKernels Loops<Lanes, Unit>::table{find_multipliers, move, measure_walls};

}  // namespace fluid_formulas
}  // namespace PLIANT_ISA
}  // namespace pliant
