// The whole frame: read this file first.
//
//   for each substep of h = dt / substeps
//     control       kinematic colliders move to where the substep ends
//     forces        wind and force fields on the velocities
//     predict       v += h g, displacement = h v                            symplectic Euler
//                   contacts of the predicted path with colliders
//     collide       contacts among surfaces
//     solve         iterations x (constraints as the chosen sweep has it, acceleration, tethers, contacts)
//     filter        steps truncated so that no surface crosses another
//     update        v from the corrections, x += displacement; restitution at colliders
//     respond       restitution among surfaces (friction is part of a contact's projection)
//
// Mueller et al. 2007, algorithm 1, with the small steps of Macklin et al. 2019.
#include "solver/step.h"

#include <chrono>

#include "solver/stages/stages.h"

namespace pliant {

namespace {

void run(const StepContext& context, double dt, Report& report) {
  Substep s = begin_frame(context, dt, report);
  for (; s.number < s.substeps; ++s.number) {
    control(s);
    apply_forces(s);
    if (!predict(s)) return;
    collide(s);
    solve(s);
    if (context.stop != nullptr && *context.stop) s.substeps = s.number + 1;  // makes this substep the frame's last
    filter(s);
    if (s.work.contact_log != nullptr) log_contacts(s, *s.work.contact_log);
    if (!update(s)) return;
    respond(s);
  }
  end_frame(s);
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
