#include "reference/volumes.h"

namespace pliant {

using detail::float_above;
using detail::float_below;

namespace {

// Factor by which merged spheres are widened; it far exceeds rounding.
constexpr double widening_factor = 1 + 1e-6;

SphereBounds sphere_about(const Vec3d& middle, double radius) { return {convert<float>(middle), float_above(radius)}; }

}  // namespace

SphereBounds SphereBounds::of(const Vec3f* points, int count) {
  const BoxBounds box = BoxBounds::of(points, count);
  const Vec3f centre = box.middle();
  double squared = 0;
  for (int i = 0; i < count; ++i)
    squared = max(squared, length_squared(convert<double>(points[i]) - convert<double>(centre)));
  return sphere_about(convert<double>(centre), sqrt(squared) * widening_factor);
}

SphereBounds SphereBounds::merged(const SphereBounds* spheres, int count) {
  // The centre of all spheres' bounding box: cheap for any number of spheres, and nearly the smallest sphere.
  Vec3f low = spheres[0].centre, high = low;
  for (int i = 0; i < count; ++i) {
    const SphereBounds& s = spheres[i];
    const Vec3f r{s.radius, s.radius, s.radius};
    low = min(low, s.centre - r);
    high = max(high, s.centre + r);
  }
  const Vec3f centre = 0.5f * low + 0.5f * high;
  double radius = 0;
  for (int i = 0; i < count; ++i)
    radius = max(radius, length(convert<double>(spheres[i].centre) - convert<double>(centre)) +
                             static_cast<double>(spheres[i].radius));
  return sphere_about(convert<double>(centre), radius * widening_factor);
}

SphereBounds SphereBounds::grown(float margin) const { return {centre, detail::rounded_up(radius + margin)}; }

float SphereBounds::distance_bound(const Vec3f& p) const {
  const double gap = length(convert<double>(p) - convert<double>(centre)) - static_cast<double>(radius);
  return gap > 0 ? float_below(gap) : 0.f;
}

bool overlap(const SphereBounds& a, const SphereBounds& b) {
  const double reach = static_cast<double>(a.radius) + static_cast<double>(b.radius);
  return length_squared(convert<double>(a.centre) - convert<double>(b.centre)) <= reach * reach;
}

}  // namespace pliant
