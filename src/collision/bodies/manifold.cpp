#include "collision/bodies/manifold.h"

#include <cstddef>

namespace pliant {

std::array<bool, 4> touching_points(const ContactPoints& points) {
  std::size_t nearest = 0;
  const auto count = static_cast<std::size_t>(points.count);
  for (std::size_t i = 1; i < count; ++i)
    if (points.gap[i] < points.gap[nearest]) nearest = i;
  std::array<bool, 4> touches{};
  for (std::size_t i = 0; i < count; ++i) {
    const float x = points.x[i] - points.x[nearest], y = points.y[i] - points.y[nearest];
    const float above = points.gap[i] - points.gap[nearest];
    touches[i] = above * above <= (touching_slope * touching_slope) * (x * x + y * y);
  }
  return touches;
}

}  // namespace pliant
