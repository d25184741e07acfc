// Advances all objects by one frame. Read this file first.
//
//   for each group of objects, side by side or in turn, and for each of its substeps of length h = dt / substeps
//     control       kinematic colliders move to their pose at the substep's end; contacts of bodies that have turned far are found again
//     forces        wind and force fields change velocities
//     predict       v += h g, displacement = h v                            symplectic Euler
//                   contacts of particles with colliders along the predicted path
//     collide       contacts between surfaces are found
//     bend          flat sheets bend as a whole
//     solve         iterations x (constraints in the order of the sweep, acceleration, tethers, contacts)
//     solve again   chains and contacts in turn, where surfaces press on one another; contacts yield a little
//     limit         the few distances that are still far too long are shortened
//     close         rigid stitches and chains in turn, where chains have pulled stitches open
//     filter        steps that would make surfaces cross are truncated; of what is free, velocities are not, and its centre of mass goes on
//     guard         where the substep has become shorter, corrections may not increase energy
//     yield         what is deformed too far keeps some of it (Plasticity)
//     update        v from the corrections, x += displacement; restitution at colliders; joints of fast wheels
//     respond       restitution between surfaces (friction is part of a contact's projection)
//   measure         overstretch of the frame, gaps of ties and stitches; how far it is from converged
//
// Mueller et al. 2007, algorithm 1, with the small steps of Macklin et al. 2019.
#include "solver/step.h"

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "solver/bodies/tie_gaps.h"
#include "solver/sheets/sheet_solver.h"
#include "solver/stages/solve_again.h"
#include "solver/stages/stages.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// True if the current substep of group `a` ends before that of `b`: (number + 1) / planned, compared without rounding.
bool ends_before(const Substep& a, const Substep& b) {
  return std::int64_t{a.number + 1} * b.planned < std::int64_t{b.number + 1} * a.planned;
}

/// The group whose current substep ends first; of equal ones the first. Null if all groups have finished the frame.
Substep* first_to_end(std::vector<Substep>& groups) {
  Substep* first = nullptr;
  for (Substep& s : groups)
    if (s.number < s.substeps && (first == nullptr || ends_before(s, *first))) first = &s;
  return first;
}

/// True if the current substeps of all groups end with that of `s`, the first to end. Only there can a frame be
/// stopped.
bool all_end_together(const std::vector<Substep>& groups, const Substep& s) {
  return std::none_of(groups.begin(), groups.end(), [&](const Substep& other) { return ends_before(s, other); });
}

/// Makes the current substep of a group, the last one if stops() is true. False if a value is not finite.
bool make_substep(Substep& s, FunctionRef<bool()> stops) {
  control(s);
  apply_forces(s);
  if (!predict(s)) return false;
  collide(s);
  bend_sheets(s);
  solve(s);
  solve_again(s);
  limit(s);
  close_stitches(s);
  s.own->free_is_known = false;
  for_systems(s, [&](System& system) { system.stop_passing(s); });
  if (stops()) s.substeps = s.number + 1;
  filter(s);
  end_filter(s);
  if (s.work.contact_log != nullptr) log_contacts(s, *s.work.contact_log);
  guard_energy(s);
  guard_bodies(s);
  note_guards(s);
  yield(s);
  if (!update(s)) return false;
  respond(s);
  count_contacts(s);
  ++s.number;
  ++s.made;
  return true;
}

/// Makes the substeps of all groups in the order of their ends, so that the frame can be stopped between them.
void run_in_turn(const StepContext& context, std::vector<Substep>& groups) {
  bool stops = false;
  while (Substep* next = first_to_end(groups)) {
    const bool is_finite = make_substep(*next, [&] {
      return stops = stops || (context.stop != nullptr && *context.stop && all_end_together(groups, *next));
    });
    if (!is_finite) return;
    begin_quarter(*next);
  }
}

/// Makes the substeps of each group up to a share of the frame, of several groups at the same time.
void run_side_by_side(const StepContext& context, std::vector<Substep>& groups, int quarter) {
  context.executor.side_by_side(static_cast<int>(groups.size()), [&](int g, int thread) {
    Substep& s = groups[static_cast<std::size_t>(g)];
    s.own = &context.workspace.of_thread[static_cast<std::size_t>(thread)];
    while (s.number < s.substeps && s.number * quarters < quarter * s.planned) {
      if (s.made > 0) begin_quarter(s);  // not at a quarter's end, where the frame may stop
      if (!make_substep(s, [] { return false; })) return;
    }
  });
}

/// The same for the whole frame, which a request to stop ends at a quarter, where all groups have reached one time.
void run_by_quarters(const StepContext& context, std::vector<Substep>& groups) {
  for (int quarter = context.stop == nullptr ? quarters : 1; quarter <= quarters; ++quarter) {
    run_side_by_side(context, groups, quarter);
    const bool failed = std::any_of(groups.begin(), groups.end(), [](const Substep& s) { return s.failed_in >= 0; });
    if (failed) return;
    if (context.stop == nullptr || !*context.stop || quarter == quarters) continue;
    for (Substep& s : groups) s.substeps = s.number;
    return;
  }
}

void run(const StepContext& context, double dt, Report& report) {
  std::vector<Substep> groups = begin_frame(context, dt);
  if (may_run_side_by_side(groups))
    run_by_quarters(context, groups);
  else
    run_in_turn(context, groups);
  if (!end_frame(groups, report)) return;
  if (!report.stopped) report.widest_tie = widest_tie(context.model, context.state);
  if (!report.stopped) warn_of_stitches(context.model, context.state, report.warnings);
  if (report.stopped) return;
  const MeasuredFrame measured{context.model, context.state, context.workspace, context.kernels.lengths};
  if (context.meter != nullptr) report.overstretch = context.meter->measure(measured, &context.executor);
  // Forces of that integrator are those of the middle of a substep.
  if (context.estimator != nullptr && !context.keeps_energy) context.estimator->add({measured, dt, context.iterations});
}

}  // namespace

void step(const StepContext& context, double dt, Report& report) {
  const auto start = std::chrono::steady_clock::now();
  context.executor.timings().clear();
  context.executor.enter([&] { run(context, dt, report); });
  if (!report.stopped) ++context.state.frame;
  report.frame = context.state.frame;
  report.time = context.state.time;
  report.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  for (const Timings::Entry& entry : context.executor.timings().entries())
    report.phases.push_back({entry.name, entry.milliseconds});
}

}  // namespace pliant
