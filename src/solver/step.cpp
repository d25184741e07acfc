// Advances all objects by one frame. Read this file first.
//
//   for each substep of length h = dt / substeps, of the group of objects whose substep ends first
//     control       kinematic colliders move to their pose at the substep's end
//     forces        wind and force fields change velocities
//     predict       v += h g, displacement = h v                            symplectic Euler
//                   contacts of particles with colliders along the predicted path
//     collide       contacts between surfaces are found
//     solve         iterations x (constraints in the order of the sweep, acceleration, tethers, contacts)
//     solve again   chains and contacts in turn, where surfaces press on one another; contacts yield a little
//     limit         the few distances that are still far too long are shortened
//     filter        steps that would make surfaces cross are truncated
//     update        v from the corrections, x += displacement; restitution at colliders
//     respond       restitution between surfaces (friction is part of a contact's projection)
//   measure         overstretch of the frame
//
// Mueller et al. 2007, algorithm 1, with the small steps of Macklin et al. 2019.
#include "solver/step.h"

#include <algorithm>
#include <chrono>
#include <cstdint>

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

/// True if the current substeps of all groups end with that of `s`, the first to end. Only there can a frame be stopped.
bool all_end_together(const std::vector<Substep>& groups, const Substep& s) {
  return std::none_of(groups.begin(), groups.end(), [&](const Substep& other) { return ends_before(s, other); });
}

void run(const StepContext& context, double dt, Report& report) {
  std::vector<Substep> groups = begin_frame(context, dt, report);
  bool stops = false;
  while (Substep* next = first_to_end(groups)) {
    Substep& s = *next;
    control(s);
    apply_forces(s);
    if (!predict(s)) return;
    collide(s);
    solve(s);
    solve_again(s);
    limit(s);
    stops = stops || (context.stop != nullptr && *context.stop && all_end_together(groups, s));
    if (stops) s.substeps = s.number + 1;  // makes this substep the last of its group
    filter(s);
    if (s.work.contact_log != nullptr) log_contacts(s, *s.work.contact_log);
    if (!update(s)) return;
    respond(s);
    if (s.is_last()) end_group(s);
    ++s.number;
    ++s.made;
    begin_quarter(s);
  }
  end_frame(groups);
  if (context.meter != nullptr && !report.stopped)
    report.overstretch = context.meter->measure({context.model, context.state, context.workspace, context.kernels.lengths},
                                                &context.executor);
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
