// The driver of constraints that are projected one at a time, in colours over each object (solver/stencil.h).
#include "solver/stencil.h"

#include "solver/drivers/driver.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// Colours with fewer batches run on one thread, because waking others takes longer.
constexpr int fewest_batches_to_share = 8;

}  // namespace

void project_stencils(Substep& s, const Phase& phase, const Pass& pass) {
  for_tasks(s, phase, "solve: stencils", fewest_batches_to_share, [&](const Task& task) {
    const CompiledObject& object = s.model.objects[task.object];
    if (pass.number >= sweep_method(object.sweep).passes) return;
    project_segment(object, object.segments[task.item], arguments(s, task.object, pass.first),
                    frame_arguments(s, task.object));
  });
}

}  // namespace pliant
