#include "world/gauge_formulas.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pliant {

namespace {

/// The length that [low, high] and the interval of a length about a middle have in common.
double common_length(float low, float high, float middle, double length) {
  const double first = std::max(static_cast<double>(low), static_cast<double>(middle) - length / 2);
  const double last = std::min(static_cast<double>(high), static_cast<double>(middle) + length / 2);
  return std::max(0.0, last - first);
}

/// True if a point of the plane is inside the parallelogram.
bool is_inside(const FlowGauge& of, const Vec3d& point) {
  const Vec3d a = convert<double>(of.side_a), b = convert<double>(of.side_b), d = point - convert<double>(of.corner);
  const Vec3d normal = cross(a, b);
  const double along_a = dot(cross(d, b), normal), along_b = dot(cross(a, d), normal), all = length_squared(normal);
  return along_a >= 0 && along_a < all && along_b >= 0 && along_b < all;
}

}  // namespace

double common_volume(const HeightGauge& box, const Vec3f& place, double side) {
  return common_length(box.low.x, box.high.x, place.x, side) * common_length(box.low.y, box.high.y, place.y, side) *
         common_length(box.low.z, box.high.z, place.z, side);
}

double passed_share(const FlowGauge& through, const Vec3f& from, const Vec3f& to, double side) {
  const Vec3d normal = cross(convert<double>(through.side_a), convert<double>(through.side_b));
  const Vec3d start = convert<double>(from), way = convert<double>(to) - start;
  const double before = dot(start - convert<double>(through.corner), normal) / (length(normal) * side);
  const double after = before + dot(way, normal) / (length(normal) * side);
  const double passed = std::clamp(after, -0.5, 0.5) - std::clamp(before, -0.5, 0.5);
  if (passed == 0) return 0;
  // The middle of the part of the way on which the particle is in the plane says whether it is inside the sides.
  const double middle = (std::clamp(after, -0.5, 0.5) + std::clamp(before, -0.5, 0.5)) / 2;
  return is_inside(through, start + way * ((middle - before) / (after - before))) ? passed : 0;
}

double front_of(std::span<const LiquidInterval> intervals, double share) {
  double volume = 0, low = std::numeric_limits<double>::infinity(), high = -low;
  for (const LiquidInterval& one : intervals) {
    volume += one.volume;
    low = std::min(low, one.middle - one.length / 2);
    high = std::max(high, one.middle + one.length / 2);
  }
  if (!(volume > 0)) return std::numeric_limits<double>::quiet_NaN();
  const auto behind = [&](double place) {
    double sum = 0;
    for (const LiquidInterval& one : intervals)
      sum += one.volume * std::clamp((place - one.middle) / one.length + 0.5, 0.0, 1.0);
    return sum;
  };
  constexpr int halvings = 48;  // of at most a few kilometres, down to rounding
  for (int i = 0; i < halvings; ++i) {
    const double middle = (low + high) / 2;
    (behind(middle) < share * volume ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace pliant
