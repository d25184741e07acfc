// Sweeps and their options by the names of the command line.
#pragma once

#include <string>

#include "pliant/scene.h"

namespace pliant::command {

/// A sweep with its options, and its name on the command line: "chains", "tiled+chebyshev".
struct Method {
  std::string name;
  Sweep sweep = Sweep::tiled;
  SweepOptions options;
};

/// Converts a name to a method. Options that it does not name are those of `base`. Throws an Error that lists the known
/// names.
Method method_of(const std::string& name, const SweepOptions& base);

}  // namespace pliant::command
