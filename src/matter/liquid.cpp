// Makes a liquid: particles, each with the mass of a cube whose side is the spacing.
#include "pliant/liquid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "pliant/error.h"

namespace pliant {

namespace {

bool is_positive(float a) { return a > 0 && std::isfinite(a); }

void require_positive(const std::string& name, const char* element, float value, const char* what) {
  if (!is_positive(value))
    throw Error({.object = name, .element = element}, "is " + std::to_string(value),
                std::string("give a positive, finite ") + what);
}

/// The places along one axis.
std::vector<float> places(float low, float high, float spacing) {
  const auto count = std::max(1, static_cast<int>(std::floor((high - low) / spacing * (1 + 1e-5f))));
  const float first = (low + high) / 2 - spacing * static_cast<float>(count - 1) / 2;
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) out.push_back(first + spacing * static_cast<float>(i));
  return out;
}

}  // namespace

std::vector<Vec3f> fill_box(const Vec3f& low, const Vec3f& high, float spacing) {
  constexpr double most_points = 1 << 26;
  require_positive("", "spacing", spacing, "distance of particles [m]");
  const Vec3f size = high - low;
  for (const float side : {size.x, size.y, size.z}) require_positive("", "side of the box", side, "length [m]");
  const auto along = [&](float side) {
    return std::max(1., std::floor(static_cast<double>(side) / static_cast<double>(spacing)));
  };
  const double points = along(size.x) * along(size.y) * along(size.z);
  if (points > most_points)
    throw Error({.element = "box"}, "would have " + std::to_string(points) + " particles",
                "give a larger spacing or a smaller box");
  std::vector<Vec3f> out;
  for (const float y : places(low.y, high.y, spacing))
    for (const float z : places(low.z, high.z, spacing))
      for (const float x : places(low.x, high.x, spacing)) out.push_back({x, y, z});
  return out;
}

Object make_liquid(const std::vector<Vec3f>& positions, const LiquidOptions& options) {
  const Fluid& fluid = options.fluid;
  if (positions.empty()) throw Error({.object = options.name}, "a liquid without particles", "give a position or more");
  require_positive(options.name, "spacing", fluid.spacing, "distance of particles [m]");
  require_positive(options.name, "density", fluid.density, "density [kg/m^3]");
  if (!(fluid.speed_of_sound >= 0) || !std::isfinite(fluid.speed_of_sound))
    throw Error({.object = options.name, .element = "speed_of_sound"}, "is " + std::to_string(fluid.speed_of_sound),
                "give a positive speed [m/s], or 0 for a liquid that does not yield");
  Object liquid;
  liquid.name = options.name;
  liquid.positions = positions;
  liquid.masses.assign(positions.size(), fluid.density * fluid.spacing * fluid.spacing * fluid.spacing);
  if (length_squared(options.velocity) > 0) liquid.velocities.assign(positions.size(), options.velocity);
  liquid.fluid = fluid;
  liquid.thickness = fluid.spacing / 2;
  liquid.collides = true;
  liquid.static_friction = liquid.kinetic_friction = 0;
  liquid.colour = {0.1f, 0.3f, 0.6f};
  return liquid;
}

}  // namespace pliant
