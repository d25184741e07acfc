// Floats that are not finite.
#pragma once

#include <limits>

namespace pliant::testing_support {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

}  // namespace pliant::testing_support
