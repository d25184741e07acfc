// The grains that most tests of grains use.
#pragma once

namespace pliant::testing_support {

inline constexpr float radius = 0.01f, diameter = 2 * radius;  // [m]
inline constexpr float gravity = 9.81f;                        // [m/s^2]

}  // namespace pliant::testing_support
