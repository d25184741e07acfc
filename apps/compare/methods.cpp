// Converts names to methods: a sweep, and options after plus signs.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "apps/compare/compare.h"
#include "pliant/error.h"

namespace pliant::compare {

namespace {

struct NamedOption {
  const char* name;
  void (*apply)(SweepOptions&);
};

constexpr NamedOption named_options[] = {
    {"tethers", [](SweepOptions& options) { options.tethers = true; }},
    {"chebyshev", [](SweepOptions& options) { options.acceleration = SweepOptions::Acceleration::chebyshev; }},
    {"average", [](SweepOptions& options) { options.sharing = SweepOptions::Sharing::average; }},
};

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::vector<std::string> sweep_names() {
  std::vector<std::string> names;
  for (const NamedSweep& one : sweeps()) names.push_back(one.name);
  return names;
}

Sweep sweep_of(const std::string& name) {
  for (const NamedSweep& one : sweeps())
    if (one.name == name) return one.sweep;
  throw Error({}, "there is no sweep '" + name + "'", "the sweeps are " + joined(sweep_names()));
}

void apply_option(const std::string& name, SweepOptions& options) {
  for (const NamedOption& one : named_options)
    if (one.name == name) return one.apply(options);
  throw Error({}, "there is no option '" + name + "' of a sweep",
              "write a sweep, then options after plus signs: " + joined(option_names()));
}

/// True if the scene has fixed points, which tethers need.
bool has_fixed(const Scene& scene) {
  const auto is_infinite = [](float mass) { return std::isinf(mass); };
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    return !object.pins.empty() || std::any_of(object.masses.begin(), object.masses.end(), is_infinite);
  });
}

}  // namespace

std::vector<std::string> option_names() {
  std::vector<std::string> names;
  for (const NamedOption& one : named_options) names.emplace_back(one.name);
  return names;
}

Method method_of(const std::string& name, const SweepOptions& base) {
  std::istringstream parts(name);
  std::string part;
  std::getline(parts, part, '+');
  Method method{name, sweep_of(part), base};
  while (std::getline(parts, part, '+')) apply_option(part, method.options);
  return method;
}

std::vector<std::string> default_methods(const Scene& scene) {
  std::vector<std::string> names;
  const bool tethers = has_fixed(scene) && !scene.settings.sweep_options.tethers;
  for (const NamedSweep& one : sweeps())  // without tethers, `tethered_chains` is `chains`
    if (one.sweep != Sweep::sequential && (one.sweep != Sweep::tethered_chains || tethers)) names.push_back(one.name);
  names.emplace_back("tiled+chebyshev");
  return names;
}

}  // namespace pliant::compare
