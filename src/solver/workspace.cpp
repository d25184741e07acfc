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

void prepare_multipliers(const Model& model, Multipliers kept, Workspace& workspace) {
  workspace.multipliers.assign(model.objects.size(), {});
  workspace.multiplier_pointers.assign(model.objects.size(), {});
  if (kept == Multipliers::none) return;
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    for (const Pool& pool : model.objects[o].pools) {
      const bool keeps = pool.law != Law::pbd && (kept == Multipliers::all || needs_multipliers(pool));
      workspace.multipliers[o].emplace_back(
          keeps ? static_cast<std::size_t>(pool.batches) * batch_width * pool.components : 0, 0.f);
    }
    for (AlignedVector<float>& values : workspace.multipliers[o]) {
      workspace.multiplier_pointers[o].push_back(values.empty() ? nullptr : values.data());
    }
  }
}

}  // namespace

void prepare(const Model& model, Multipliers kept, Workspace& workspace) {
  workspace.displacements.resize(model.particles());
  workspace.frames.predicted.resize(model.frames());
  workspace.frames.corrections.resize(model.frames());
  prepare_multipliers(model, kept, workspace);
  workspace.volume_multipliers.assign(model.objects.size(), 0);
  bool some_volume = false;
  for (const CompiledObject& object : model.objects) some_volume = some_volume || object.has_volume;
  if (some_volume) workspace.volume_gradients.resize(model.particles());
  workspace.triangle_forces.resize(model.objects.size());
  workspace.tiles.resize(model.tiles.size());
  workspace.gravity.resize(model.objects.size());
}

void prepare_sweep(const Model& model, const Settings& settings, Workspace& workspace) {
  const SweepOptions& options = settings.sweep_options;
  if (settings.sweep == Sweep::multigrid) prepare_multigrid(model, workspace.sweep.multigrid);
  if (settings.sweep == Sweep::jacobi) prepare_jacobi(model, options, workspace.sweep.jacobi);
  if (options.acceleration == SweepOptions::Acceleration::chebyshev) {
    prepare_chebyshev(model, workspace, workspace.sweep.chebyshev);
  }
  if (settings.record_residuals) workspace.sweep.predicted.resize(model.particles());
}

}  // namespace pliant
