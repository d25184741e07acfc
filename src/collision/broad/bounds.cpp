#include "collision/broad/bounds.h"

namespace pliant {

float BoxBounds::distance_bound(const Vec3f& p) const {
  const Vec3d below = convert<double>(low) - convert<double>(p), above = convert<double>(p) - convert<double>(high);
  const Vec3d outside = max(max(below, above), Vec3d{0, 0, 0});
  return detail::float_below(length(outside));
}

}  // namespace pliant
