#include <array>

#include "solver/drivers/driver.h"

namespace pliant {

namespace {

/// The table of drivers: one row for each value of Driver, in the order of the enumeration.
constexpr std::array<PhaseDriver, driver_count> drivers{{
    {Turn::sweep, true, &project_tiles},
    {Turn::sweep, true, &project_inter_tile},
    {Turn::sweep, false, &release_held},
    {Turn::sweep, false, &project_chains},
    {Turn::sweep, false, &project_volumes},
    {Turn::stencil, false, &project_stencils},
    {Turn::stencil, false, &project_clusters},
    {Turn::last, false, &hold_tethers},
    {Turn::last, false, &project_surface_contacts},
    {Turn::last, false, &project_collider_contacts},
}};

}  // namespace

const PhaseDriver& driver_of(const Phase& phase) { return drivers[static_cast<std::size_t>(phase.driver)]; }

void walk(Substep& s, Turn turn, const Pass& pass) {
  const std::vector<Phase>& phases = s.phases();
  const std::size_t count = phases.size();
  const bool forward = pass.order == Order::forward;
  InterTileTimer timer(s);
  for (std::size_t i = 0; i < count; ++i) {
    const Phase& phase = phases[forward ? i : count - 1 - i];
    const PhaseDriver& driver = driver_of(phase);
    if (driver.turn != turn || (!forward && !driver.has_order)) continue;
    timer.enter(phase);
    driver.project(s, phase, pass);
  }
}

void walk(Substep& s, Driver driver, const Pass& pass) {
  for (const Phase& phase : s.phases())
    if (phase.driver == driver) driver_of(phase).project(s, phase, pass);
}

void for_tasks(Substep& s, const Phase& phase, const char* name, int fewest_to_share,
               FunctionRef<void(const Task&)> body) {
  const int tasks = static_cast<int>(phase.tasks.size());
  const auto visit = [&](int i) {
    if (is_swept(s, phase.tasks[i].object)) body(phase.tasks[i]);
  };
  if (phase.work >= fewest_to_share) return s.context.executor.parallel_for(name, tasks, visit);
  std::optional<Stopwatch> watch;
  if (name != nullptr) watch.emplace(s.context.executor.timings(), name);
  for (int i = 0; i < tasks; ++i) visit(i);
}

void InterTileTimer::enter(const Phase& phase) {
  const bool is_timed_here = phase.driver == Driver::inter_tile && phase.work < fewest_inter_tile_batches;
  if (!is_timed_here) watch_.reset();
  if (is_timed_here && !watch_) watch_.emplace(timings_, inter_tile_name);
}

}  // namespace pliant
