// Lower bounds of distances: measured once, then used until motion has spent them.
//
// A pair of primitives is measured rarely. In between, an odometer adds up by how much any distance between the two clusters can
// have fallen, and a bound subtracts what has been added since it was measured:
//
//     value   |<------------------- distance when it was measured ------------------->|
//             |<-- total - since: spent so far -->|<-- next: this substep -->|<- after() ->|
//                                                                            what is certainly left
//
//   a pair         is measured again  when after() <= thickness (contacts) or <= the filter's margin
//   a near list    is skipped whole   while the least bound of its pairs stays above that
//   a near list    is rebuilt         when the odometer has used up the margin it was made with: pairs farther away were left out
//   clusters       are paired again   when one has travelled as far as its box was grown (ClusterMotions)
//
// The odometer counts what is left of the motion once the rigid motion of the clusters is removed. Points p and q that go to
// p + m + w x p and q + m + w x q come no nearer: p - q + w x (p - q) is no shorter than p - q. So cloth that falls, swings or
// turns as a whole spends nothing. For straight paths this holds without an error of second order.
//
// Bounds only save work. Every decision about a pair is made from its own distance and paths in this substep, so a State
// that is put back gives the same bits whatever the bounds were.
#pragma once

#include "math/vector.h"

namespace pliant {

/// Below any distance: to be measured before anything else.
inline constexpr float not_measured = -1e30f;
/// Above any distance.
inline constexpr float out_of_reach = 1e30f;
/// A bound is a sum of floats: pairs are dismissed only when they are out of reach by more than this factor.
inline constexpr float cull_slack = 1.0001f;
/// A sum from which motion is subtracted later is rounded some ten times.
inline constexpr float sum_slack = 1 - 1e-6f;
/// One rounding of a float, relative.
inline constexpr float one_rounding = 6e-8f;

/// By how much any distance between two clusters can have fallen.
struct Odometer {
  float next = 0;   ///< in this substep [m]
  float total = 0;  ///< in the substeps before it, since the clusters were paired [m]

  void advance() { total = (total + next) * (1 + 1e-6f); }
};

/// A lower bound of a distance.
struct Bound {
  float value = not_measured;  ///< when the odometer's total was `since` [m]
  float since = 0;             ///< [m]

  float spent(const Odometer& odometer) const { return odometer.total - since; }
  /// What is left at the end of this substep [m].
  float after(const Odometer& odometer) const { return value - (spent(odometer) + odometer.next); }
  /// Whether anything is left at the end of this substep.
  bool lasts(const Odometer& odometer) const { return spent(odometer) + odometer.next <= value; }
};

}  // namespace pliant
