// The driver of constraints that are projected one at a time, in colours over each object (solver/stencil.h).
#include "solver/stencil.h"

#include "constraints/registry.h"
#include "solver/drivers/driver.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// Colours with fewer batches run on one thread, because waking others takes longer.
constexpr int fewest_batches_to_share = 8;

/// True for ties that project_ties begins, of the objects with 1 in `of`.
bool begin_early(const std::vector<char>& of, const CompiledObject& object, const Task& task) {
  return of[task.object] != 0 && solves_chains(object.sweep) &&
         constraint_type(object.pools[object.segments[task.item].pool].type).is_tie;
}

void project_task(Substep& s, const Task& task, bool first) {
  const CompiledObject& object = s.model.objects[task.object];
  project_segment(object, object.segments[task.item], arguments(s, task.object, first),
                  frame_arguments(s, task.object));
}

}  // namespace

void project_stencils(Substep& s, const Phase& phase, const Pass& pass) {
  for_tasks(s, phase, "solve: stencils", fewest_batches_to_share, [&](const Task& task) {
    const CompiledObject& object = s.model.objects[task.object];
    if (pass.number >= sweep_method(object.sweep).passes) return;
    const bool has_begun = pass.tied != nullptr && begin_early(*pass.tied, object, task);
    project_task(s, task, pass.first && !has_begun);
  });
}

void project_ties(Substep& s, const std::vector<char>& of) {
  for (const Phase& phase : s.phases()) {
    if (phase.driver != Driver::stencil) continue;
    for_tasks(s, phase, "solve: stencils", fewest_batches_to_share, [&](const Task& task) {
      if (begin_early(of, s.model.objects[task.object], task)) project_task(s, task, true);
    });
  }
}

}  // namespace pliant
