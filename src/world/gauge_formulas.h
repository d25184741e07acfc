// What gauges sum over particles. A particle is a cube that is parallel to the axes, or along other directions an
// interval of that length.
#pragma once

#include <span>
#include <vector>

#include "math/vector.h"
#include "pliant/gauges.h"

namespace pliant {

/// The volume that a box and the cube about a place have in common [m^3].
double common_volume(const HeightGauge& box, const Vec3f& place, double side);

/// The share of a particle of that size that passed through the parallelogram in the direction of side_a x side_b while
/// it moved along a straight line; negative against it [-].
double passed_share(const FlowGauge& through, const Vec3f& from, const Vec3f& to, double side);

/// An interval of liquid along a direction.
struct LiquidInterval {
  double middle = 0, length = 0, volume = 0;  ///< [m], [m], [m^3]
};

/// The place that a share of the volume is behind; NaN if there is none [m].
double front_of(std::span<const LiquidInterval> intervals, double share);

}  // namespace pliant
