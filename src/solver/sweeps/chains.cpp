#include "solver/sweeps/chains.h"

#include <algorithm>

#include "solver/passes.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// Below this many links of sixteen lanes, waking other threads costs more than solving a colour.
constexpr int fewest_steps_to_share = 96;
/// Particles per task of the tether loop.
constexpr int particles_per_task = 4096;

void solve_one(const Model& model, const ChainKernels& kernels, const ChainPhase::Task& task, const SweepArguments& a,
               float* scratch) {
  const CompiledObject& object = model.objects[task.object];
  const ChainBatch& batch = object.chains[task.batch];
  float* multipliers = a.multipliers != nullptr ? a.multipliers[batch.pool] : nullptr;
  // One or two paths, such as a rope, are solved faster one by
  // one than in mostly empty SIMD lanes. The bits are the same.
  const bool few = object.segments[batch.first_segment].last_count <= 2;
  const ChainKernels& by = few ? chain_kernels_sequential() : kernels;
  by.solve_chain(object.pools[batch.pool], object.segments.data() + batch.first_segment, batch.steps,
                 object.chain_softness.data() + static_cast<std::ptrdiff_t>(task.batch) * batch_width, multipliers, a,
                 scratch);
}

}  // namespace

void iterate_chains(Substep& s, bool first) {
  if (!(first && s.sweeps_on_entry)) sweep_tiles(s, first, Order::forward);  // constraints outside chains
  sweep_inter_tile(s, first, Order::forward);
  solve_chains(s, first);
  sweep_volumes(s, first);
}

void ChainScratch::prepare(const SweepSetup& setup, int object) {
  std::size_t room = 0;
  for (const ChainBatch& batch : setup.model.objects[object].chains)
    room = std::max(room, static_cast<std::size_t>(batch.steps) * chain_scratch_floats);
  of_thread.resize(setup.threads);
  for (auto& scratch : of_thread) scratch.resize(std::max(scratch.size(), room));
}

void solve_chains(Substep& s, bool first_pass) {
  const ChainKernels& kernels = s.kernels.chains;
  std::vector<AlignedVector<float>>& scratch = static_cast<ChainScratch&>(*s.group->scratch).of_thread;
  for (const ChainPhase& phase : s.model.chains) {
    const int tasks = static_cast<int>(phase.tasks.size());
    const int shares = phase.steps < fewest_steps_to_share ? 1 : std::min(tasks, static_cast<int>(scratch.size()));
    for_tasks(s, "solve: chains", shares, [&](int share) {  // strided, because neighbouring paths have similar lengths
      for (int i = share; i < tasks; i += shares) {
        const ChainPhase::Task& task = phase.tasks[i];
        solve_one(s.model, kernels, task, arguments(s, task.object, first_pass), scratch[share].data());
      }
    });
  }
}

void hold_tethers(Substep& s) {
  const ChainKernels& kernels = s.kernels.chains;
  for (int o = 0; o < static_cast<int>(s.model.objects.size()); ++o) {
    const CompiledObject& object = s.model.objects[o];
    if (object.tethers.slots == 0) continue;
    const SweepArguments a = arguments(s, o, false);
    // A copy, so that no thread reads records that another thread writes.
    Records& anchors = s.work.anchors[o];
    for (std::size_t i = 0; i < object.tethers.anchors.size(); ++i) {
      anchors[2 * i] = a.positions[object.tethers.anchors[i]];
      anchors[2 * i + 1] = a.displacements[object.tethers.anchors[i]];
    }
    const int tasks = (object.particles + particles_per_task - 1) / particles_per_task;
    for_tasks(s, "solve: tethers", tasks, [&](int task) {
      const int first = task * particles_per_task, last = std::min(first + particles_per_task, object.particles);
      kernels.hold_tethers(object.tethers, anchors.data(), first, last, a);
    });
  }
}

}  // namespace pliant
