// Manifolds as rows of numbers, one lane for each: what the passes over contacts of bodies read and write.
//
// ManifoldRows<16> is a block of sixteen manifolds of one colour for the SIMD kernels, ManifoldRows<1> a single one.
// Points that a manifold does not have, and lanes that a block does not fill, have zeros and a gap so large that no
// impulse acts there.
#pragma once

#include <cstddef>
#include <cstdint>

#include "collision/bodies/manifold.h"

namespace pliant {

/// The gap of a point that does not exist [m].
inline constexpr float no_point = 1e30f;

/// The members of Manifold by lanes. First what both passes use, then what one of them uses, then what is used once a
/// frame.
template <int lanes>
struct ManifoldRows {
  float normal[3][lanes], tangent[3][lanes];  ///< the second tangent is normal x tangent
  float arm_a[3][lanes], arm_b[3][lanes];
  float x[4][lanes], y[4][lanes];
  float friction[lanes], sliding[lanes], drift[2][lanes];
  float mobility[6][lanes], mass[4][lanes], slide[3][lanes], twist_mass[lanes], twist_arm[lanes];
  float impulse[4][lanes], friction_impulse[2][lanes], twist_impulse[lanes];
  float gap_now[4][lanes];
  float gap[4][lanes];
  float restitution[lanes], bounced[lanes];
  float settles[lanes];
  float spinning[lanes];
  float rolling[lanes], rolling_impulse[2][lanes];  ///< used only where some manifold of the block has rolling friction
};

/// A BodyMotion consists of so many Records.
inline constexpr int records_a_motion = 8;

/// Sixteen manifolds of one colour and their bodies.
struct alignas(64) ManifoldBlock {
  ManifoldRows<16> rows;
  std::int32_t a[16], b[16];       ///< bodies, as indices of their first Record; free lanes repeat those of lane 0
  std::uint32_t moves_a, moves_b;  ///< bit l: body a or b of lane l is dynamic; clear in free lanes
  std::int32_t lanes;              ///< number of manifolds, in the first lanes
  std::int32_t bounces;            ///< 1: some manifold has restitution
  std::int32_t rolls;              ///< 1: some manifold has rolling friction
  std::int32_t settles;            ///< 1: some manifold begins at rest
};

template <int lanes>
void set_row(const Vec3f& v, float (&row)[3][lanes], int lane) {
  row[0][lane] = v.x;
  row[1][lane] = v.y;
  row[2][lane] = v.z;
}

/// Sets lane `lane` to manifold `m` as prepare needs it, without what prepare computes.
template <int lanes>
void put_manifold(const Manifold& m, ManifoldRows<lanes>& rows, int lane) {
  set_row(m.normal, rows.normal, lane);
  set_row(m.tangent1, rows.tangent, lane);
  set_row(m.arm_a, rows.arm_a, lane);
  set_row(m.arm_b, rows.arm_b, lane);
  for (int i = 0; i < 4; ++i) {
    const auto point = static_cast<std::size_t>(i);
    const bool exists = i < m.count;
    rows.x[i][lane] = exists ? m.x[point] : 0;
    rows.y[i][lane] = exists ? m.y[point] : 0;
    rows.gap[i][lane] = exists ? m.gap[point] : no_point;
    rows.gap_now[i][lane] = exists ? m.gap_now[point] : no_point;
    rows.impulse[i][lane] = exists ? m.impulse[point] : 0;
  }
  rows.friction_impulse[0][lane] = m.friction_impulse[0];
  rows.friction_impulse[1][lane] = m.friction_impulse[1];
  rows.twist_impulse[lane] = m.twist_impulse;
  rows.rolling_impulse[0][lane] = m.rolling_impulse[0];
  rows.rolling_impulse[1][lane] = m.rolling_impulse[1];
  rows.rolling[lane] = m.rolling;
  rows.spinning[lane] = m.spinning;
  rows.friction[lane] = m.friction;
  rows.sliding[lane] = m.sliding;
  rows.drift[0][lane] = m.drift[0];
  rows.drift[1][lane] = m.drift[1];
  rows.restitution[lane] = m.restitution;
  rows.bounced[lane] = m.bounced;
  rows.settles[lane] = m.settles;
}

/// Copies what the passes change, impulses and present gaps, back to a manifold.
template <int lanes>
void take_impulses(const ManifoldRows<lanes>& rows, int lane, Manifold& m) {
  for (int i = 0; i < m.count; ++i) {
    m.impulse[static_cast<std::size_t>(i)] = rows.impulse[i][lane];
    m.gap_now[static_cast<std::size_t>(i)] = rows.gap_now[i][lane];
  }
  m.bounced = rows.bounced[lane];
  m.friction_impulse = {rows.friction_impulse[0][lane], rows.friction_impulse[1][lane]};
  m.twist_impulse = rows.twist_impulse[lane];
  m.rolling_impulse = {rows.rolling_impulse[0][lane], rows.rolling_impulse[1][lane]};
}

}  // namespace pliant
