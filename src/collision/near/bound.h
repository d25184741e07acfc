// Lower bounds of distances: measured once, then valid until the accumulated motion exceeds them.
//
// Pairs of primitives are measured rarely. In between, an odometer sums the largest possible decrease of any distance
// between two clusters. A bound subtracts what the odometer has counted since the measurement:
//
//     value   |<------------------- distance when it was measured ------------------->|
//             |<-- total - since: spent so far -->|<-- next: this substep -->|<- after() ->|
//                                                                            remaining lower bound
//
//   a pair         is measured again  if its after() is within the thickness (contacts) or the filter's margin
//   a near list    is skipped whole   while the least after() of its pairs exceeds both
//   a near list    is rebuilt         when the odometer exceeds the margin of its search, which left out farther pairs
//   clusters       are paired again   when one has travelled as far as its box was grown (ClusterMotions)
//
// The odometer counts the residual motion, after the rigid motion of the clusters is removed. Points p and q that move
// rigidly, to p + m + w x p and q + m + w x q, come no nearer: |p - q + w x (p - q)| >= |p - q|. So cloth in rigid
// motion costs nothing. For straight paths this is exact, without a second-order error.
//
// Bounds only save work. Every decision about a pair uses its own distance and path in this substep. So a restored
// State gives the same bits whatever the bounds were.
#pragma once

#include "math/vector.h"

namespace pliant {

/// The value of a bound that was never measured: below any distance, so that its pair is measured first.
inline constexpr float not_measured = -1e30f;
/// A value above any distance.
inline constexpr float out_of_reach = 1e30f;
/// Safety factor on distances: pairs are culled only if they are farther by it, because a bound is a sum of floats.
inline constexpr float cull_slack = 1.0001f;
/// Safety factor on sums from which motion is subtracted later; it covers about ten roundings.
inline constexpr float sum_slack = 1 - 1e-6f;
/// Relative error of one float rounding.
inline constexpr float one_rounding = 6e-8f;

/// Upper bound of the decrease of any distance between two clusters.
struct Odometer {
  float next = 0;   ///< possible decrease in this substep [m]
  float total = 0;  ///< possible decrease in earlier substeps, since the clusters were paired [m]

  void advance() { total = (total + next) * (1 + 1e-6f); }
};

/// A lower bound of a distance that was measured once. It decreases as the odometer counts.
struct Bound {
  float value = not_measured;  ///< lower bound when the odometer's total was `since` [m]
  float since = 0;             ///< the odometer's total at the measurement [m]

  float spent(const Odometer& odometer) const { return odometer.total - since; }
  /// What remains of the bound at the end of this substep [m].
  float after(const Odometer& odometer) const { return value - (spent(odometer) + odometer.next); }
  /// True if the motion up to the end of this substep does not exceed the bound.
  bool lasts(const Odometer& odometer) const { return spent(odometer) + odometer.next <= value; }
};

}  // namespace pliant
