#include "solver/substep_group.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "model/length_ranges.h"
#include "model/object_sets.h"

namespace pliant {

namespace {

/// The substeps for tethers of `edges` edges: edges^1.5 over this. Hung by two corners, cloth of 64, 128, 256 and 512 rows
/// needs some 4, 10, 27 and 77 (docs/internals/default_settings.md).
constexpr double edges_to_hang = 150;
constexpr int most_to_hang = 100;

SetMember member_of(const CompiledObject& object) {
  if (object.particles == 0) return {};  // the object was removed
  return {object.groups,      object.mask,         object.collides && !object.is_collider,
          object.is_collider, object.own_substeps, object.substep_rule};
}

/// Copies a phase with the tasks of a group only. Phases whose tasks are found in each substep have none, and are kept.
Phase part_of(const Phase& phase, const std::vector<char>& has) {
  Phase part{phase.driver, phase.colour};
  for (const Task& task : phase.tasks) {
    if (has[task.object] == 0) continue;
    part.tasks.push_back(task);
    part.work += task.work;
  }
  return part;
}

/// True if the limit of overstretch applies: other sweeps leave whole regions too long, which shortening one constraint
/// after another does not mend.
bool limits_lengths(Sweep sweep) { return solves_chains(sweep) || sweep == Sweep::multigrid; }

/// True if the object is cloth that hangs by tethers; without a fixed particle there are none. A rope is not counted: its
/// free end swings fast, few substeps let it stretch and gain energy, and it is cheap.
bool hangs(const CompiledObject& object) {
  return object.sweep == Sweep::tethered_chains && !object.surface.triangles.empty() && !object.tethers.anchors.empty();
}

double mean_length(const CompiledObject& object) {
  double sum = 0, count = 0;
  for (const LengthRange& range : object.lengths)
    for_lengths(object, range, [&](const Pool& pool, int first, int last) {
      for (int s = first; s < last; ++s)
        for (int b = 0; b < object.segments[s].batches; ++b) {
          const float* rest = pool.row(0, std::int64_t{object.segments[s].first_batch} + b);
          sum = std::accumulate(rest, rest + batch_width, sum);  // lanes of padding repeat one of the batch
          count += batch_width;
        }
    });
  return sum / std::max(count, 1.);
}

/// The longest of the shortest tethers of each particle [m].
double longest_tether(const Tethers& tethers) {
  const std::size_t slots = std::max(tethers.slots, 1), batches = tethers.rows.size() / slots;
  double longest = 0;
  for (std::size_t batch = 0; batch < batches; ++batch)
    for (std::size_t lane = 0; lane < batch_width; ++lane) {
      float shortest = no_tether;
      for (std::size_t slot = 0; slot < slots; ++slot)
        shortest = std::min(shortest, tethers.lengths[(batch * slots + slot) * batch_width + lane]);
      if (shortest < no_tether) longest = std::max(longest, static_cast<double>(shortest));
    }
  return longest;
}

/// The substeps that cloth needs to hang by tethers: the finer it is, the more.
int substeps_to_hang(const CompiledObject& object) {
  const double edges = longest_tether(object.tethers) / std::max(mean_length(object), 1e-30);
  return static_cast<int>(std::min(edges * std::sqrt(edges) / edges_to_hang, double(most_to_hang)));
}

void list_lengths(const Model& model, SubstepGroup& group) {
  group.hangs = group.by_state;
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) {
    const CompiledObject& object = model.objects[o];
    if (object.particles == 0 || !(group.has_all || group.has[o] != 0)) continue;
    group.hangs = group.hangs && (object.is_collider || hangs(object));
    if (group.hangs && !object.is_collider) group.least_hanging = std::max(group.least_hanging, substeps_to_hang(object));
    if (!limits_lengths(object.sweep)) continue;
    for (int i = 0; i < static_cast<int>(object.lengths.size()); ++i)
      group.lengths.push_back({o, i, object.lengths[i].batches});
  }
}

/// The group with the objects whose key is `key`.
SubstepGroup group_of(const Model& model, const std::vector<int>& of_object, int key, const SetSubsteps& of_set) {
  SubstepGroup group;
  group.substeps = of_set.substeps;
  group.by_state = of_set.by_state;
  group.least = of_set.least;
  group.has_all = false;
  for (std::size_t o = 0; o < of_object.size(); ++o) {
    const CompiledObject& object = model.objects[o];
    const bool is_in = object.particles > 0 && of_object[o] == key;
    group.has.push_back(is_in ? 1 : 0);
    if (!is_in) continue;
    group.objects.push_back(static_cast<int>(o));
    const bool is_new = std::find(group.sweeps.begin(), group.sweeps.end(), object.sweep) == group.sweeps.end();
    if (!object.is_collider && is_new) group.sweeps.push_back(object.sweep);
  }
  for (std::size_t task = 0; task < model.tiles().size(); ++task)
    if (group.has[model.tiles()[task].object] != 0) group.tiles.push_back(static_cast<int>(task));
  for (const Phase& phase : model.phases) {
    Phase part = part_of(phase, group.has);
    if (phase.tasks.empty() || !part.tasks.empty()) group.phases.push_back(std::move(part));
  }
  list_lengths(model, group);
  return group;
}

/// Sets that share a group have the same key, in ascending order of substeps; each set that follows its State has its own.
int key_of(const SetSubsteps& set) {
  constexpr int most = 10000;  // Settings::substeps
  return set.by_state ? most + 1 + set.set : set.substeps;
}

}  // namespace

SubstepGroup group_of_all(const Model& model, int substeps, bool by_state, int least) {
  SubstepGroup group;
  group.substeps = substeps;
  group.by_state = by_state;
  group.least = least;
  list_lengths(model, group);
  return group;
}

std::vector<SubstepGroup> make_substep_groups(const Model& model) {
  std::vector<SetMember> members;
  for (const CompiledObject& object : model.objects) members.push_back(member_of(object));
  std::map<int, SetSubsteps> keys;
  std::vector<int> of_object;
  for (const SetSubsteps& set : substeps_of_sets(members)) {
    of_object.push_back(key_of(set));
    if (of_object.back() > 0) keys.try_emplace(of_object.back(), set);
  }
  std::vector<SubstepGroup> groups;
  if (keys.size() < 2) {
    const SetSubsteps all = keys.empty() ? SetSubsteps{0, substeps_of_others} : keys.begin()->second;
    groups.push_back(group_of_all(model, all.substeps, all.by_state, all.least));
    return groups;
  }
  for (int& key : of_object) key = key > 0 ? key : keys.begin()->first;
  for (const auto& [key, set] : keys) groups.push_back(group_of(model, of_object, key, set));
  return groups;
}

}  // namespace pliant
