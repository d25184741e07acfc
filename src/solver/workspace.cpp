#include "solver/workspace.h"

#include "solver/sweeps/chebyshev.h"
#include "solver/sweeps/jacobi.h"
#include "solver/sweeps/multigrid.h"

namespace pliant {

namespace {

/// Rigid constraints move the same whatever their multipliers are, and PBD has none.
bool needs_multipliers(const Pool& pool) {
  const std::size_t response = pool.row_offset.size() - (pool.law == Law::damped ? 2 : 1);
  const bool rigid = pool.row_offset[response] < 0 && *pool.row(static_cast<int>(response), 0) == 0;
  return pool.law != Law::pbd && !rigid;
}

void prepare_multipliers(const CompiledObject& object, Multipliers kept, std::vector<AlignedVector<float>>& multipliers,
                         std::vector<float*>& pointers) {
  multipliers.clear();
  pointers.clear();
  if (kept == Multipliers::none) return;
  for (const Pool& pool : object.pools) {
    const bool keeps = pool.law != Law::pbd && (kept == Multipliers::all || needs_multipliers(pool));
    multipliers.emplace_back(keeps ? static_cast<std::size_t>(pool.batches) * batch_width : 0, 0.f);
  }
  for (AlignedVector<float>& values : multipliers) pointers.push_back(values.empty() ? nullptr : values.data());
}

/// What is indexed by objects, particles and tiles.
void resize(const Model& model, Workspace& workspace) {
  const std::size_t objects = model.objects.size();
  workspace.displacements.resize(model.particles());
  workspace.multipliers.resize(objects);
  workspace.multiplier_pointers.resize(objects);
  workspace.volume_multipliers.resize(objects);
  workspace.triangle_forces.resize(objects);
  workspace.gravity.resize(objects);
  workspace.tiles.resize(model.tiles.size());
  if (!workspace.volume_gradients.empty()) workspace.volume_gradients.resize(model.particles());
}

}  // namespace

void prepare(const Model& model, Multipliers kept, Workspace& workspace) {
  resize(model, workspace);
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) prepare(model, o, kept, workspace);
}

void prepare(const Model& model, int object, Multipliers kept, Workspace& workspace) {
  resize(model, workspace);
  const CompiledObject& from = model.objects[object];
  prepare_multipliers(from, kept, workspace.multipliers[object], workspace.multiplier_pointers[object]);
  workspace.volume_multipliers[object] = 0;
  workspace.triangle_forces[object] = {};
  if (from.has_volume) workspace.volume_gradients.resize(model.particles());
}

void prepare_sweep(const Model& model, const Settings& settings, Workspace& workspace) {
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) prepare_sweep(model, o, settings, workspace);
}

void prepare_sweep(const Model& model, int object, const Settings& settings, Workspace& workspace) {
  const SweepOptions& options = settings.sweep_options;
  if (settings.sweep == Sweep::multigrid) prepare_multigrid(model, object, workspace.sweep.multigrid);
  if (settings.sweep == Sweep::jacobi) prepare_jacobi(model, object, options, workspace.sweep.jacobi);
  if (options.acceleration == SweepOptions::Acceleration::chebyshev)
    prepare_chebyshev(model, object, workspace, workspace.sweep.chebyshev);
  if (settings.record_residuals) workspace.sweep.predicted.resize(model.particles());
}

}  // namespace pliant
