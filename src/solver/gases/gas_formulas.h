// The formulas of a gas apart from its density, each for one particle.
#pragma once

#include "math/functions.h"
#include "math/vector.h"
#include "pliant/material.h"
#include "solver/fluids/vorticity_formulas.h"

namespace pliant::gas_formulas {

using vorticity_formulas::gradient_factor;

inline bool contains(const Region& region, const Vec3f& p) {
  const Vec3f d = p - region.centre;
  if (region.radius > 0) return length_squared(d) < region.radius * region.radius;
  const Vec3f& half = region.half_size;
  return abs(d.x) <= half.x && abs(d.y) <= half.y && abs(d.z) <= half.z;
}

/// How the air around accelerates a gas, over -g: its density over that of the gas.
inline float lift(const Gas& gas, float density, float temperature) {
  return gas.ambient_density / density * (temperature / gas.ambient_temperature);
}

/// The share of a difference that is left after a time.
inline float share_left(float rate, float seconds) {
  return static_cast<float>(exp(-static_cast<double>(rate) * static_cast<double>(seconds)));
}

/// The temperature after heaters and the air around have acted.
inline float exchanged(const Gas& gas, const Vec3f& place, float temperature, float seconds) {
  if (gas.cooling_time > 0)
    temperature =
        gas.ambient_temperature + (temperature - gas.ambient_temperature) * share_left(1 / gas.cooling_time, seconds);
  for (const GasHeater& heater : gas.heaters)
    if (contains(heater.region, place))
      temperature = heater.temperature + (temperature - heater.temperature) * share_left(heater.rate, seconds);
  return temperature;
}

/// The velocity after drag of the air, which acts where neighbours are missing. Implicit, so that the terminal velocity
/// is exact.
inline Vec3f braked(const Gas& gas, const Vec3f& velocity, const Vec3f& air, float density, float seconds) {
  const float missing = max(1 - density, 0.f), rate = gas.drag * missing * seconds;
  return velocity + (air - velocity) * (rate / (1 + rate));
}

}  // namespace pliant::gas_formulas
