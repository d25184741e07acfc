#include "solver/sweeps/chains.h"

#include <algorithm>

#include "solver/frame.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// Below this many links of sixteen lanes a colour is done sooner than other threads can be told of it.
constexpr int fewest_steps_to_share = 96;
/// Particles of a task that holds tethers.
constexpr int particles_per_task = 4096;

void solve_one(const Model& model, const ChainKernels& kernels, const ChainPhase::Task& task, const SweepArguments& a,
               float* scratch) {
  const CompiledObject& object = model.objects[task.object];
  const ChainBatch& batch = object.chains[task.batch];
  float* multipliers = a.multipliers != nullptr ? a.multipliers[batch.pool] : nullptr;
  // One or two paths, such as a rope, are done sooner one by one than in lanes that are mostly empty. The bits are the
  // same.
  const bool few = object.segments[batch.first_segment].last_count <= 2;
  const ChainKernels& by = few ? chain_kernels_sequential() : kernels;
  by.solve_chain(object.pools[batch.pool], object.segments.data() + batch.first_segment, batch.steps,
                 object.chain_softness.data() + static_cast<std::ptrdiff_t>(task.batch) * batch_width, multipliers, a,
                 scratch);
}

}  // namespace

void iterate_chains(Frame& frame, bool first) {
  if (!(first && frame.swept_on_entry())) frame.sweep_tiles(first, Order::forward);  // what is not in chains
  frame.sweep_straddlers(first, Order::forward);
  frame.sweep_chains(first);
  frame.sweep_volumes(first);
}

void prepare_chains(const Model& model, int threads, Workspace& workspace) {
  int longest = 0;
  for (const CompiledObject& object : model.objects)
    for (const ChainBatch& batch : object.chains) longest = std::max(longest, batch.steps);
  workspace.chain_scratch.resize(longest > 0 ? threads : 0);
  for (auto& scratch : workspace.chain_scratch) scratch.resize(static_cast<std::size_t>(longest) * chain_scratch_floats);
  workspace.anchors.resize(model.objects.size());
  for (std::size_t o = 0; o < model.objects.size(); ++o)
    workspace.anchors[o].resize(2 * model.objects[o].tethers.anchors.size());
}

void solve_chains(const Model& model, const ChainKernels& kernels, Workspace& workspace, Executor& executor,
                  FunctionRef<SweepArguments(int)> arguments) {
  for (const ChainPhase& phase : model.chains) {
    const int tasks = static_cast<int>(phase.tasks.size());
    const int shares =
        phase.steps < fewest_steps_to_share ? 1 : std::min(tasks, static_cast<int>(workspace.chain_scratch.size()));
    executor.parallel_for("solve: chains", shares, [&](int share) {  // dealt out like cards: neighbours are alike in length
      for (int i = share; i < tasks; i += shares)
        solve_one(model, kernels, phase.tasks[i], arguments(phase.tasks[i].object), workspace.chain_scratch[share].data());
    });
  }
}

void hold_tethers(const Model& model, const ChainKernels& kernels, Workspace& workspace, Executor& executor,
                  FunctionRef<SweepArguments(int)> arguments) {
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) {
    const CompiledObject& object = model.objects[o];
    if (object.tethers.slots == 0) continue;
    const SweepArguments a = arguments(o);
    // A copy of what is read by all, so that no thread reads records that another writes, be it with what they hold.
    Records& anchors = workspace.anchors[o];
    for (std::size_t i = 0; i < object.tethers.anchors.size(); ++i) {
      anchors[2 * i] = a.positions[object.tethers.anchors[i]];
      anchors[2 * i + 1] = a.displacements[object.tethers.anchors[i]];
    }
    const int tasks = (object.particles + particles_per_task - 1) / particles_per_task;
    executor.parallel_for("solve: tethers", tasks, [&](int task) {
      const int first = task * particles_per_task;
      kernels.hold_tethers(object.tethers, anchors.data(), first, std::min(first + particles_per_task, object.particles),
                           a);
    });
  }
}

}  // namespace pliant
