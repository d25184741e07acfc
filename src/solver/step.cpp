// The frame, whole: this is the page to read first.
//
//   for each substep of h = dt / substeps
//     forces        wind and force fields on the velocities (where there are any)
//     predict       v += h g, displacement = h v                            symplectic Euler
//     collide       contacts of the predicted path with the colliders
//                   and, where surfaces meet, contacts among them
//     solve         iterations x (constraints as the chosen sweep has it, acceleration, tethers, contacts)
//     filter        moves shortened so that no surface crosses another
//     update        v from the corrections, x += displacement
//     respond       restitution where something touched (friction is part of a contact's projection)
//
// Mueller et al. 2007, algorithm 1, with the small steps of Macklin et al. 2019. What a tile needs from one substep to the
// next is its own affair, so update, respond, predict, collide and the first sweep are one visit to each tile while it is
// in the cache: the end of a substep stands at the start of the next. Only outside forces and
// contacts among surfaces, which need all velocities, part the two.
#include "solver/step.h"

#include <chrono>

#include "solver/forces.h"
#include "solver/frame.h"
#include "solver/residual.h"
#include "solver/sweeps/chebyshev.h"
#include "solver/sweeps/record.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// Whether a tolerance is set and met, with iterations left that it saves.
bool is_last(const StepContext& context, Frame& frame, int iteration) {
  return context.tolerance > 0 && iteration + 1 < context.iterations && distance_residual(frame) < context.tolerance;
}

/// The iterations of one substep, and how many they were. By default (sweeps/tiled.cpp): tiles, what straddles them, volumes.
int solve(const StepContext& context, Frame& frame, bool records) {
  const bool accelerates = context.options.acceleration == SweepOptions::Acceleration::chebyshev;
  if (records) record_prediction(frame);
  for (int iteration = 0; iteration < context.iterations; ++iteration) {
    if (accelerates) keep_iterate(frame, iteration);
    sweep_method(context.sweep).iterate(frame, iteration == 0);
    if (accelerates) accelerate(frame, iteration);
    frame.hold_tethers();
    if (frame.has_pairs()) frame.sweep_pairs();
    frame.sweep_contacts();  // last, so that what is drawn does not reach into what it lies on
    if (records) record_iteration(frame, iteration + 1);
    if (is_last(context, frame, iteration)) return iteration + 1;
  }
  return context.iterations;
}

void run(const StepContext& context, Frame& frame) {
  const bool forces = has_forces(context.model), parted = forces || frame.has_pairs();
  for (int substep = 0; substep < context.substeps; ++substep) {
    const bool first = substep == 0;
    frame.begin_substep(substep);
    if (parted) {
      if (!first) frame.finish_tiles(false);
      if (frame.give_up(substep - 1)) return;
      if (!first && frame.has_pairs()) frame.respond_to_pairs(false);
      if (forces) frame.apply_external_forces(substep);
    }

    // The end of the last substep, prediction and contacts of this one, and mostly its first sweep over each tile.
    frame.enter_tiles(!first && !parted);
    if (frame.give_up(substep - 1)) return;
    if (frame.has_pairs()) frame.find_pairs();
    frame.count_iterations(solve(context, frame, context.record_residuals && substep + 1 == context.substeps));
    if (frame.has_pairs()) frame.filter_pairs(substep + 1 == context.substeps);
  }
  frame.finish_tiles(true);
  if (frame.give_up(context.substeps - 1)) return;
  if (frame.has_pairs()) frame.respond_to_pairs(true);
  frame.end();
}

}  // namespace

void step(const StepContext& context, double dt, Report& report) {
  const auto start = std::chrono::steady_clock::now();
  context.executor.timings().clear();
  for (TileScratch& tile : context.workspace.tiles) tile.finite = true;
  context.executor.enter([&] {
    Frame frame(context, dt, report);
    run(context, frame);
  });
  ++context.state.frame;
  report.frame = context.state.frame;
  report.time = context.state.time;
  report.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  for (const Timings::Entry& entry : context.executor.timings().entries())
    report.phases.push_back({entry.name, entry.milliseconds});
}

}  // namespace pliant
