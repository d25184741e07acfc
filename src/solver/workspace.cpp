#include "solver/workspace.h"

namespace pliant {

namespace {

void prepare_multipliers(const Model& model, bool keeps_multipliers, Workspace& workspace) {
  workspace.multipliers.assign(model.objects.size(), {});
  workspace.multiplier_pointers.assign(model.objects.size(), {});
  if (!keeps_multipliers) return;
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    for (const Pool& pool : model.objects[o].pools) {
      workspace.multipliers[o].emplace_back(static_cast<std::size_t>(pool.batches) * batch_width, 0.f);
      workspace.multiplier_pointers[o].push_back(workspace.multipliers[o].back().data());
    }
  }
}

}  // namespace

void prepare(const Model& model, bool keeps_multipliers, Workspace& workspace) {
  workspace.displacements.resize(model.particles());
  prepare_multipliers(model, keeps_multipliers, workspace);
  workspace.volume_multipliers.assign(model.objects.size(), 0);
  bool some_volume = false;
  for (const CompiledObject& object : model.objects) some_volume = some_volume || object.has_volume;
  if (some_volume) workspace.volume_gradients.resize(model.particles());
  workspace.triangle_forces.resize(model.objects.size());
  workspace.tiles.resize(model.tiles.size());
  workspace.gravity.resize(model.objects.size());
}

}  // namespace pliant
