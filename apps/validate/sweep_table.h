// A table of all variants of the solver. The tests of sweeps, the golden hashes and `pliant validate sweeps` use it, so
// a new line makes all of them test a new sweep.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant::validate {

/// A property that a variant does not have.
enum class Lacks {
  nothing,
  pairs,  ///< Newton's third law: without it momentum is not conserved, and compliant constraints rest elsewhere
  give,   ///< elastic stretch: tethers limit what is meant to stretch
  force,  ///< multipliers that show the whole force: tethers carry part of the load
  turns,  ///< rotation: if edges rotate far in a step, a linearised correction leaves much to later sweeps
};

struct SweepWay {
  std::string name;
  Sweep sweep;
  SweepOptions options;
  Lacks lacks = Lacks::nothing;
};

/// Prints the variant's name in the output of tests.
inline void PrintTo(const SweepWay& way, std::ostream* out) { *out << way.name; }

/// The default options after a change has been applied.
template <class Change>
SweepOptions options_with(const Change& change) {
  SweepOptions options;
  options.plain_iterations = 3;  // so few that Chebyshev acts within few iterations
  change(options);
  return options;
}

inline const std::vector<SweepWay>& sweep_ways() {
  const auto plain = options_with([](SweepOptions&) {});
  const auto chebyshev = options_with([](SweepOptions& o) { o.acceleration = SweepOptions::Acceleration::chebyshev; });
  const auto at_once = options_with([](SweepOptions& o) {
    o.acceleration = SweepOptions::Acceleration::chebyshev;
    o.plain_iterations = 1;
    o.spectral_radius = 0.5f;
  });
  const auto tethers = options_with([](SweepOptions& o) { o.tethers = true; });
  const auto over = options_with([](SweepOptions& o) { o.relaxation = 1.3f; });
  const auto under = options_with([](SweepOptions& o) { o.relaxation = 0.7f; });
  const auto average = options_with([](SweepOptions& o) {
    o.relaxation = 1.5f;
    o.sharing = SweepOptions::Sharing::average;
  });
  static const std::vector<SweepWay> ways{
      {"tiled", Sweep::tiled, plain},
      {"sequential", Sweep::sequential, plain},
      {"symmetric", Sweep::symmetric, plain},
      {"natural", Sweep::natural, plain},
      {"jacobi_split", Sweep::jacobi, plain},
      {"jacobi_average", Sweep::jacobi, average, Lacks::pairs},
      {"over_relaxed", Sweep::tiled, over},
      {"under_relaxed_symmetric", Sweep::symmetric, under},
      {"chebyshev_tiled", Sweep::tiled, chebyshev},
      {"chebyshev_symmetric", Sweep::symmetric, chebyshev},
      {"chebyshev_jacobi", Sweep::jacobi, chebyshev},
      {"chebyshev_at_once", Sweep::tiled, at_once},
      {"chains", Sweep::chains, plain},
      {"multigrid", Sweep::multigrid, plain, Lacks::turns},
      {"tethered_chains", Sweep::tethered_chains, plain, Lacks::force},
      {"chebyshev_chains", Sweep::chains, chebyshev},
      {"tiled_tethers", Sweep::tiled, tethers, Lacks::give},
      {"chains_tethers", Sweep::chains, tethers, Lacks::give},
  };
  return ways;
}

}  // namespace pliant::validate
