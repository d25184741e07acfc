#include "solver/substep_group.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/at.h"
#include "model/attachments.h"
#include "model/length_ranges.h"
#include "model/object_sets.h"
#include "solver/near_sets.h"

namespace pliant {

namespace {

/// The substeps for tethers of `edges` edges: edges^1.5 over this. Hung by two corners, cloth of 64, 128, 256 and 512
/// rows needs some 4, 10, 27 and 77 (docs/internals/default_settings_tried.md).
constexpr double edges_to_hang = 150;
constexpr int most_to_hang = 100;

SetMember member_of(const CompiledObject& object) {
  if (object.particles == 0) return {};  // the object was removed
  const Fluid fluid = object.fluid.value_or(Fluid{.spacing = 0});
  return {object.groups,
          object.mask,
          object.collides && !object.is_collider,
          object.is_collider,
          object.own_substeps,
          object.substep_rule,
          fluid.spacing,
          fluid.speed_of_sound,
          object.grains.has_value(),
          object.grain_heights,
          object.gas || object.tracers};
}

/// True if the limit of overstretch applies: other sweeps leave whole regions too long, which shortening one constraint
/// after another does not mend.
bool limits_lengths(Sweep sweep) { return solves_chains(sweep) || sweep == Sweep::multigrid; }

/// True if the object is cloth that hangs by tethers; without a fixed particle there are none. A rope is not counted,
/// nor cloth that swings about one place: its free end swings fast, and few substeps let it stretch.
bool hangs(const CompiledObject& object) {
  if (object.sweep != Sweep::tethered_chains || object.surface.triangles.empty()) return false;
  std::vector<Vec3f> all, anchors;
  all.reserve(object.positions.size());
  anchors.reserve(object.tethers.anchors.size());
  for (const Record& p : object.positions) all.push_back({p.x, p.y, p.z});
  for (const int anchor : object.tethers.anchors) anchors.push_back(all[static_cast<std::size_t>(anchor)]);
  return largest_extent(anchors) > swinging_share * largest_extent(all);
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

/// A triangle whose longest edge is so many times as long as its shortest one is a sliver.
constexpr float sliver_ratio = 20;
/// The least substeps of sheets of slivers that follow the State. The few that their State demands at rest leave errors
/// that are small beside long edges and large beside short ones, and stretch those when more follow: a fan of 1 : 127
/// had 16 % in 85 substeps.
constexpr int substeps_of_slivers = 60;

/// True if over one in a hundred triangles is a sliver at the start.
bool has_slivers(const CompiledObject& object) {
  std::size_t slivers = 0;
  for (const auto& [a, b, c] : object.surface.triangles) {
    const auto squared = [&](int i, int j) {
      const Record &p = object.positions[at(i)], &q = object.positions[at(j)];
      return length_squared(Vec3f{q.x - p.x, q.y - p.y, q.z - p.z});
    };
    const auto [least, most] = std::minmax({squared(a, b), squared(b, c), squared(c, a)});
    slivers += most > sliver_ratio * sliver_ratio * least ? 1 : 0;
  }
  return 100 * slivers > object.surface.triangles.size();
}

void list_lengths(const Model& model, int o, SubstepGroup& group) {
  const CompiledObject& object = model.objects[o];
  if (object.particles == 0) return;
  group.has_sheets = group.has_sheets || (!object.is_collider && !object.surface.triangles.empty());
  group.hangs = group.hangs && (object.is_collider || hangs(object));
  if (group.hangs && !object.is_collider) group.least_hanging = std::max(group.least_hanging, substeps_to_hang(object));
  if (!limits_lengths(object.sweep)) return;
  if (group.by_state && solves_chains(object.sweep) && has_slivers(object)) {
    group.least = std::max(group.least, substeps_of_slivers);
    group.least_hanging = std::max(group.least_hanging, substeps_of_slivers);
  }
  for (int i = 0; i < static_cast<int>(object.lengths.size()); ++i)
    group.lengths.push_back({o, i, object.lengths[i].batches});
}

/// Sets what follows from the objects of a group alone, but for its tiles and phases.
void describe(const Model& model, SubstepGroup& group) {
  for (const int o : group.objects) {
    const CompiledObject& object = model.objects[o];
    const bool is_new = std::find(group.sweeps.begin(), group.sweeps.end(), object.sweep) == group.sweeps.end();
    if (!object.is_collider && is_new) group.sweeps.push_back(object.sweep);
    list_lengths(model, o, group);
  }
}

/// The earlier group of the same objects as `group`, none of which changed; null if there is none.
SubstepGroup* same_before(const GroupsBefore& before, const SubstepGroup& group) {
  if (before.groups.empty() || before.groups.front().has_all || group.objects.empty()) return nullptr;
  const std::vector<int>& group_of_object = *before.groups.front().group_of_object;
  const auto first = static_cast<std::size_t>(group.objects.front());
  if (first >= group_of_object.size() || group_of_object[first] < 0) return nullptr;
  SubstepGroup& candidate = before.groups[static_cast<std::size_t>(group_of_object[first])];
  const auto has_changed = [&](int o) { return std::binary_search(before.changed.begin(), before.changed.end(), o); };
  const bool is_same = candidate.objects == group.objects && candidate.by_state == group.by_state;
  return is_same && std::none_of(group.objects.begin(), group.objects.end(), has_changed) ? &candidate : nullptr;
}

/// Takes from an earlier group of the same objects all that follows from them.
void take_over(SubstepGroup& from, SubstepGroup& group) {
  group.hangs = from.hangs;
  group.least_hanging = from.least_hanging;
  group.least = std::max(group.least, from.least);
  group.has_sheets = from.has_sheets;
  group.sweeps = std::move(from.sweeps);
  group.lengths = std::move(from.lengths);
  group.phases = std::move(from.phases);
}

/// Copies phases to the groups that have none, each with the tasks of its objects. Phases whose tasks are found in each
/// substep have no tasks, and all groups get them. `of_object` is the group of each object, or -1.
void divide_phases(const Model& model, const std::vector<int>& of_object, std::vector<SubstepGroup>& groups) {
  std::vector<const Phase*> last(groups.size(), nullptr);  // the last phase of which each group has a part
  std::vector<char> is_done(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) is_done[g] = groups[g].phases.empty() ? 0 : 1;
  for (const Phase& phase : model.phases) {
    if (phase.tasks.empty())
      for (std::size_t g = 0; g < groups.size(); ++g)
        if (is_done[g] == 0) groups[g].phases.push_back(phase);
    for (const Task& task : phase.tasks) {
      const int g = of_object[task.object];
      if (g < 0 || is_done[static_cast<std::size_t>(g)] != 0) continue;
      if (std::exchange(last[g], &phase) != &phase) groups[g].phases.push_back({phase.driver, phase.colour});
      Phase& part = groups[g].phases.back();
      part.tasks.push_back(task);
      part.work += task.work;
    }
  }
}

/// Sets that share a group have the same key, in ascending order of substeps; each set that follows its State has its
/// own.
int key_of(const SetSubsteps& set) {
  constexpr int most = 10000;  // Settings::substeps
  return set.by_state ? most + 1 + set.set : set.substeps;
}

/// The key of each object, and the substeps of each key. Objects without a key belong to the first one.
struct GroupKeys {
  std::vector<int> of_object;
  std::map<int, SetSubsteps> substeps;
};

/// True if there is a mesh collider that touches no object, but may touch some elsewhere: not a grid or heightfield.
bool has_lone_collider(const Model& model, const GroupKeys& keys) {
  for (std::size_t o = 0; o < model.objects.size(); ++o)
    if (keys.of_object[o] == 0 && model.objects[o].particles > 0 && model.objects[o].groups != 0) return true;
  return false;
}

GroupKeys find_keys(const Model& model, const std::vector<int>* given) {
  const std::vector<SetMember> members = set_members(model);
  GroupKeys keys;
  keys.of_object.reserve(members.size());
  for (const SetSubsteps& set : given != nullptr ? substeps_of_sets(members, *given) : substeps_of_sets(members)) {
    keys.of_object.push_back(key_of(set));
    if (keys.of_object.back() > 0) keys.substeps.try_emplace(keys.of_object.back(), set);
  }
  if (keys.substeps.empty()) keys.substeps.emplace(0, SetSubsteps{0, substeps_of_others});
  // A collider beside a set that follows its State has a group of its own, so that the set gets the bits that it gets
  // alone.
  if (keys.substeps.begin()->second.by_state && has_lone_collider(model, keys))
    keys.substeps.emplace(1, SetSubsteps{0, 1});
  for (int& key : keys.of_object) key = key > 0 ? key : keys.substeps.begin()->first;
  return keys;
}

}  // namespace

std::vector<SetMember> set_members(const Model& model) {
  std::vector<SetMember> members;
  members.reserve(model.objects.size());
  for (const CompiledObject& object : model.objects) members.push_back(member_of(object));
  return members;
}

SubstepGroup group_of_all(const Model& model, int substeps, bool by_state, int least) {
  SubstepGroup group;
  group.substeps = substeps;
  group.by_state = by_state;
  group.least = least;
  group.hangs = by_state;
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) list_lengths(model, o, group);
  return group;
}

std::vector<SubstepGroup> make_substep_groups(const Model& model, const GroupsBefore* before,
                                              const std::vector<int>* sets) {
  const GroupKeys keys = find_keys(model, sets);
  std::vector<SubstepGroup> groups;
  if (keys.substeps.size() < 2) {
    const SetSubsteps& all = keys.substeps.begin()->second;
    groups.push_back(group_of_all(model, all.substeps, all.by_state, all.least));
    return groups;
  }
  std::map<int, int> group_of_key;
  groups.reserve(keys.substeps.size());
  const auto group_of_object = std::make_shared<std::vector<int>>(model.objects.size(), -1);
  std::vector<int>& of_object = *group_of_object;
  for (const auto& [key, set] : keys.substeps) {
    group_of_key.emplace(key, static_cast<int>(groups.size()));
    SubstepGroup& group = groups.emplace_back();
    group.number = static_cast<int>(groups.size()) - 1;
    group.group_of_object = group_of_object;
    group.substeps = set.substeps;
    group.by_state = group.hangs = set.by_state;
    group.least = set.least;
    group.has_all = false;
  }
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) {
    if (model.objects[o].particles == 0) continue;  // the object was removed
    of_object[o] = group_of_key.at(keys.of_object[o]);
    groups[of_object[o]].objects.push_back(o);
  }
  for (SubstepGroup& group : groups) {
    SubstepGroup* same = before == nullptr ? nullptr : same_before(*before, group);
    same != nullptr ? take_over(*same, group) : describe(model, group);
  }
  for (int task = 0; task < static_cast<int>(model.tiles().size()); ++task)
    if (const int g = of_object[model.tiles()[task].object]; g >= 0) groups[g].tiles.push_back(task);
  divide_phases(model, of_object, groups);
  return groups;
}

std::vector<SetSubsteps> planned_substeps(const Model& model, const std::vector<int>* sets) {
  const GroupKeys keys = find_keys(model, sets);
  std::vector<SetSubsteps> out;
  out.reserve(keys.of_object.size());
  for (const int key : keys.of_object) {
    out.push_back(keys.substeps.at(key));
    if (!out.back().by_state) out.back().set = 0;  // sets with a fixed number share a group
  }
  return out;
}

}  // namespace pliant
