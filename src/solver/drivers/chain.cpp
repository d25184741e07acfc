// The driver of chains: direct solves along paths of distance constraints.
//
// Gauss-Seidel propagates a force by one edge per pass, so finely meshed cloth that hangs from two corners needs
// thousands of passes. Solving whole rows, columns and diagonals exactly propagates it from end to end in one pass.
#include <algorithm>

#include "solver/bodies/body_solver.h"
#include "solver/drivers/driver.h"
#include "solver/sweeps/chain_kernels.h"
#include "solver/sweeps/chain_loaded.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// A colour with fewer steps (one link of sixteen paths) runs on one thread, because waking others would cost more.
constexpr int fewest_steps_to_share = 96;

void solve_one(const Substep& s, const Task& task, const SweepArguments& a, AlignedVector<float>& scratch) {
  const CompiledObject& object = s.model.objects[task.object];
  const ChainBatch& batch = object.chains[task.item];
  const std::size_t room = static_cast<std::size_t>(batch.steps) * chain_scratch_floats;
  if (scratch.size() < room) scratch.resize(room);
  float* multipliers = a.multipliers != nullptr ? a.multipliers[batch.pool] : nullptr;
  const Segment* const links = object.segments.data() + batch.first_segment;
  const float* const softness = object.chain_softness.data() + static_cast<std::ptrdiff_t>(task.item) * batch_width;
  const ChainTask chains{object.pools[batch.pool], links, batch.steps, softness, multipliers};
  // One or two paths, such as a rope, are solved faster one by
  // one than in mostly empty SIMD lanes. The bits are the same.
  const bool few = links->last_count <= 2;
  const ChainKernels& by = few ? chain_kernels_sequential() : s.kernels.chains;
  const auto solve_all = [&] {
    by.solve_chain(chains.pool, links, batch.steps, softness, multipliers, a, scratch.data());
  };
  const bool may_be_loaded = s.bodies != nullptr && s.bodies->loads().has_any(task.object);
  if (!may_be_loaded) return solve_all();
  const std::uint32_t lanes = s.bodies->loads().loaded_lanes(task.object, task.item);
  if (lanes == 0) return solve_all();
  const ChainLoads loads = s.bodies->loads().of(s.model.first[task.object]);
  if (lanes != (1u << links->last_count) - 1) {
    const KeptLanes kept(chains, lanes, a);
    solve_all();
    kept.restore();
  }
  solve_loaded_chains(chains, lanes, a, loads, scratch.data());
}

}  // namespace

void project_chains(Substep& s, const Phase& phase, const Pass& pass) {
  if (!solves_chains(s.group->sweep)) return;
  std::vector<AlignedVector<float>>& scratch = s.own->chains;
  const int tasks = static_cast<int>(phase.tasks.size());
  const int shares = phase.work < fewest_steps_to_share ? 1 : std::min(tasks, static_cast<int>(scratch.size()));
  if (s.bodies != nullptr) s.bodies->loads().begin_chains(s);
  for_tasks(s, "solve: chains", shares, [&](int share) {  // every n-th task, because neighbouring paths are alike
    for (int i = share; i < tasks; i += shares) {
      const Task& task = phase.tasks[i];
      if (!is_swept(s, task.object) || (pass.only != nullptr && (*pass.only)[task.object] == 0)) continue;
      solve_one(s, task, arguments(s, task.object, pass.first), scratch[share]);
    }
  });
  if (s.bodies != nullptr) s.bodies->end_chains(s);
}

}  // namespace pliant
