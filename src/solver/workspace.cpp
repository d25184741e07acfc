#include "solver/workspace.h"

#include <algorithm>

#include "solver/bodies/joint_forest.h"
#include "solver/sweeps/chebyshev.h"

namespace pliant {

namespace {

/// True if a pool's multipliers must be stored. Rigid constraints move the same without them; PBD constraints have
/// none. Constraints projected one at a time keep theirs: bounds need them, and they are the reactions of joints.
bool needs_multipliers(const Pool& pool) {
  if (!pool.in_lanes) return pool.law != Law::pbd;
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
    multipliers.emplace_back(keeps ? static_cast<std::size_t>(pool.batches) * batch_width * pool.components : 0, 0.f);
  }
  for (AlignedVector<float>& values : multipliers) pointers.push_back(values.empty() ? nullptr : values.data());
}

/// Resizes all arrays that are indexed by objects, particles or tiles.
void resize(const Model& model, Workspace& workspace) {
  const std::size_t objects = model.objects.size();
  workspace.displacements.resize(model.particles());
  workspace.expected_velocities.resize(model.particles());
  workspace.joints.resize(objects);
  workspace.frames.starts.resize(model.frames());
  workspace.frames.round.resize(model.frames());
  workspace.frames.predicted.resize(model.frames());
  workspace.frames.corrections.resize(model.frames());
  workspace.multipliers.resize(objects);
  workspace.multiplier_pointers.resize(objects);
  workspace.pointers_before_last.resize(objects);
  workspace.stores_in_last.resize(objects);
  workspace.volume_multipliers.resize(objects);
  workspace.cluster_multipliers.resize(objects);
  workspace.triangle_forces.resize(objects);
  workspace.gravity.resize(objects);
  workspace.last_h.resize(objects);
  workspace.anchors.resize(objects);
  workspace.sheets.resize(objects);
  workspace.tiles.resize(model.tiles().size());
  if (!workspace.volume_gradients.empty()) workspace.volume_gradients.resize(model.particles());
}

SweepGroup& group_of(Sweep sweep, Workspace& workspace) {
  SweepGroup& group = workspace.sweeps[sweep];
  if (group.method != nullptr) return group;
  group.sweep = sweep;
  group.method = &sweep_method(sweep);
  if (group.method->make_scratch != nullptr) group.scratch = group.method->make_scratch();
  return group;
}

}  // namespace

void prepare(const Model& model, Multipliers kept, Workspace& workspace) {
  resize(model, workspace);
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) prepare(model, o, kept, workspace);
}

void prepare(const Model& model, int object, Multipliers kept, Workspace& workspace) {
  resize(model, workspace);
  const CompiledObject& from = model.objects[object];
  const int frame = model.first_frame[object];
  std::fill_n(workspace.frames.round.begin() + frame, model.end_of_frames(object) - frame,
              Record{});  // those of another object before
  prepare_multipliers(from, kept, workspace.multipliers[object], workspace.multiplier_pointers[object]);
  workspace.pointers_before_last[object] = workspace.multiplier_pointers[object];
  for (std::size_t pool = 0; pool < workspace.pointers_before_last[object].size(); ++pool)
    if (kept <= Multipliers::lengths && !from.pools[pool].is_length && from.pools[pool].in_lanes)
      workspace.pointers_before_last[object][pool] = nullptr;
  const bool has_stencils =
      std::any_of(from.pools.begin(), from.pools.end(), [](const Pool& p) { return !p.in_lanes; });
  workspace.stores_in_last[object] = kept == Multipliers::lengths_in_last && !has_stencils ? 1 : 0;
  workspace.volume_multipliers[object] = 0;
  workspace.cluster_multipliers[object].assign(from.clusters.has_multipliers ? from.clusters.members.size() : 0, {});
  workspace.joints[object] = {};
  prepare_joints(from, workspace.joints[object]);
  workspace.last_h[object] = 0;
  if (static_cast<std::size_t>(object) < workspace.joint_loads.size())
    workspace.joint_loads[static_cast<std::size_t>(object)] = {};
  workspace.triangle_forces[object] = {};
  workspace.anchors[object].resize(2 * from.tethers.anchors.size());
  workspace.shape_contacts.prepare(model, object);
  if (from.has_volume) workspace.volume_gradients.resize(model.particles());
}

void prepare_sweeps(const Model& model, const Settings& settings, int threads, Workspace& workspace) {
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o)
    prepare_sweep(model, o, settings, threads, workspace);
}

void prepare_sweep(const Model& model, int object, const Settings& settings, int threads, Workspace& workspace) {
  if (settings.record_residuals) workspace.predicted.resize(model.particles());
  const CompiledObject& of = model.objects[object];
  const bool accelerates = settings.sweep_options.acceleration == SweepOptions::Acceleration::chebyshev;
  if (!of.is_collider && of.particles > 0) {  // colliders and removed objects have no constraints
    SweepGroup& group = group_of(of.sweep, workspace);
    if (accelerates && !group.acceleration) group.acceleration = std::make_unique<ChebyshevScratch>();
  }
  for (auto& [sweep, group] : workspace.sweeps) {
    const SweepSetup setup{model, workspace, settings.sweep_options, sweep, threads};
    if (group.scratch) group.scratch->prepare(setup, object);
    if (group.acceleration) group.acceleration->prepare(setup, object);
  }
}

void drop_unused_sweeps(const Model& model, Workspace& workspace) {
  std::erase_if(workspace.sweeps, [&](const auto& group) {
    return std::none_of(model.objects.begin(), model.objects.end(), [&](const CompiledObject& object) {
      return !object.is_collider && object.particles > 0 && object.sweep == group.first;
    });
  });
}

}  // namespace pliant
