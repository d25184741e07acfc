// Runs the iterations of a substep.
#include <algorithm>

#include "solver/bodies/body_solver.h"
#include "solver/bodies/joint_forest.h"
#include "solver/bodies/joint_load.h"
#include "solver/drivers/driver.h"
#include "solver/momentum.h"
#include "solver/residual.h"
#include "solver/stages/stages.h"
#include "solver/sweeps/chebyshev.h"
#include "solver/sweeps/record.h"

namespace pliant {

namespace {

/// True if the settings have a tolerance, the residual is below it, and further iterations are planned.
bool is_met(Substep& s, int iteration) {
  const StepContext& context = s.context;
  return context.tolerance > 0 && iteration + 1 < context.iterations && distance_residual(s) < context.tolerance;
}

/// True if any object that takes part in this substep is solved by the given sweep.
bool uses(const Substep& s, Sweep sweep) {
  return s.part == nullptr || std::find(s.part->sweeps.begin(), s.part->sweeps.end(), sweep) != s.part->sweeps.end();
}

/// Projects stencil constraints as often as the sweep of their object projects the other constraints. Ties of the
/// objects with 1 in `tied` have begun.
void walk_stencils(Substep& s, bool first, const std::vector<char>& tied) {
  int passes = 0;
  for (const auto& [sweep, group] : s.work.sweeps)
    if (uses(s, sweep)) passes = std::max(passes, group.method->passes);
  for (int pass = 0; pass < passes; ++pass) {
    walk(s, Turn::stencil, {first && pass == 0, Order::forward, pass, nullptr, tied.empty() ? nullptr : &tied});
    for_systems(s, [&](System& system) { system.project_neighbours(s, first && pass == 0); });
    solve_joint_trees(s, first && pass == 0);
  }
}

using MomentumFunction = void (*)(Substep& s, Since since, const std::vector<char>* only);

/// Notes or conserves the momentum of what a sweep does. Objects with 1 in `pressed` have been moved since their
/// prediction.
void treat_momentum(Substep& s, bool is_first, const std::vector<char>& pressed, MomentumFunction treat) {
  if (!is_first || pressed.empty()) return treat(s, is_first ? Since::prediction : Since::note, nullptr);
  std::vector<char> others(pressed.size());
  std::transform(pressed.begin(), pressed.end(), others.begin(), [](char is_pressed) { return is_pressed == 0; });
  treat(s, Since::prediction, &others);
  treat(s, Since::note, &pressed);
}

/// Runs one iteration: for each sweep group its phases and acceleration, then the phases of all groups together.
void iterate(Substep& s, int iteration) {
  static const std::vector<char> none;
  const std::vector<char>& pressed = iteration == 0 && s.bodies != nullptr ? s.bodies->press_joints(s) : none;
  const bool is_pushed = s.has_pairs() && s.pairs->untangles();  // since the prediction
  const bool is_first = iteration == 0 && !is_pushed;
  if (!pressed.empty()) project_ties(s, pressed);
  for (const auto& [sweep, group] : s.work.sweeps) {
    if (!uses(s, sweep)) continue;
    s.group = &group;
    if (group.acceleration) keep_iterate(s, iteration);
    treat_momentum(s, is_first, pressed, note_momentum);
    group.method->iterate(s, iteration == 0);
    treat_momentum(s, is_first, pressed, conserve_momentum);
    if (group.acceleration) accelerate(s, iteration);
  }
  s.group = nullptr;
  walk_stencils(s, iteration == 0, pressed);
  for_systems(s, [&](System& system) { system.project(s, iteration == 0); });
  walk(s, Turn::last, {});
}

/// Iterates until the tolerance is met or the planned iterations are done. Returns the number of iterations.
int iterate_to_tolerance(Substep& s) {
  const bool records = s.context.record_residuals && s.is_last();
  if (records) record_prediction(s);
  for (int iteration = 0; iteration < s.context.iterations; ++iteration) {
    iterate(s, iteration);
    if (records) record_iteration(s, iteration + 1);
    if (is_met(s, iteration)) return iteration + 1;
  }
  return s.context.iterations;
}

void count_iterations(Substep& s, int iterations) {
  IterationCount& count = s.report.iterations;
  count.smallest = s.made == 0 ? iterations : std::min(count.smallest, iterations);
  count.largest = std::max(count.largest, iterations);
  s.iterations_made += iterations;
  count.mean = static_cast<double>(s.iterations_made) / (s.made + 1);
}

}  // namespace

void solve(Substep& s) {
  count_iterations(s, iterate_to_tolerance(s));
  if (s.work.sums_joint_loads) add_joint_loads(s);
  break_joints(s);
}

}  // namespace pliant
