// The grains that most tests of grains use.
#pragma once

namespace pliant::testing_support {

inline constexpr float grain_radius = 0.01f, grain_diameter = 2 * grain_radius;  // [m]
inline constexpr float gravity = 9.81f;                                          // [m/s^2]

}  // namespace pliant::testing_support
