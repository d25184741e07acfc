// Tracers: points that gases carry along, with a lifetime. They have the velocity that the kernel interpolates from the
// particles around.
#pragma once

#include <vector>

#include "solver/gases/gas_solver.h"

namespace pliant {

/// A pass over the tracers of an object.
struct TracerPass {
  int object = 0;
  double since = 0;   ///< time of the last pass [s]
  float seconds = 0;  ///< since then
  Vec3f gravity{};    ///< that velocities do not include yet [m/s]
};

/// Emits tracers, lets them age, and sets the velocities of all. Those that are not there rest in the middle of the
/// source.
void advance_tracers(Substep& s, const std::vector<GasPass>& gases, const TracerPass& pass);

/// The place of tracer number `number` of those that a source ever emits: by a hash, so that it depends on nothing
/// else.
Vec3f place_in(const Region& region, std::uint64_t number);

/// How many tracers a source has emitted at a time [s].
std::int64_t emitted_until(const Tracers& tracers, double time);

}  // namespace pliant
