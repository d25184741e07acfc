// Which methods are compared by default.
#include <algorithm>
#include <cmath>

#include "apps/compare/compare.h"

namespace pliant::compare {

namespace {

/// True if the scene has fixed points, which tethers need.
bool has_fixed(const Scene& scene) {
  const auto is_infinite = [](float mass) { return std::isinf(mass); };
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    return !object.pins.empty() || std::any_of(object.masses.begin(), object.masses.end(), is_infinite);
  });
}

}  // namespace

std::vector<std::string> default_methods(const Scene& scene) {
  std::vector<std::string> names;
  const bool tethers = has_fixed(scene) && !scene.settings.sweep_options.tethers;
  for (const NamedSweep& one : sweeps())  // without tethers, `tethered_chains` is `chains`
    if (one.sweep != Sweep::sequential && (one.sweep != Sweep::tethered_chains || tethers)) names.push_back(one.name);
  names.emplace_back("tiled+chebyshev");
  return names;
}

}  // namespace pliant::compare
