#include "apps/command_line/sweep_names.h"

#include <sstream>
#include <vector>

#include "apps/command_line/usage.h"
#include "pliant/error.h"

namespace pliant::command {

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

/// The options that may follow a sweep's name after a plus sign.
std::vector<std::string> option_names() {
  std::vector<std::string> names;
  for (const NamedOption& one : named_options) names.emplace_back(one.name);
  return names;
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

}  // namespace

Method method_of(const std::string& name, const SweepOptions& base) {
  std::istringstream parts(name);
  std::string part;
  std::getline(parts, part, '+');
  Method method{name, sweep_of(part), base};
  while (std::getline(parts, part, '+')) apply_option(part, method.options);
  return method;
}

}  // namespace pliant::command
