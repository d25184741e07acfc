// Makes the substep groups of a World, keeps their contact between surfaces up to date, and plans their frames.
#include "world/groups.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "inspect/inspect_scene.h"
#include "solver/divide.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// True if surfaces of a group may meet.
bool can_touch(const Model& model, const SubstepGroup& group) {
  return std::any_of(group.objects.begin(), group.objects.end(), [&](int o) {
    const CompiledObject& object = model.objects[o];
    return object.self_collision || object.collides || object.is_collider;
  });
}

/// Makes the contact between surfaces for all objects of a group.
void make_pairs(WorldData& world, SubstepGroup& group) {
  std::unique_ptr<PairModel>& pairs = group.has_all ? world.groups.pairs_of_all : group.pair_model;
  std::unique_ptr<SurfaceContact>& contact = group.has_all ? world.workspace.pairs : group.pairs;
  contact = nullptr;
  pairs = nullptr;
  if (!group.has_all && !can_touch(world.model, group)) return;
  if (world.groups.tables == nullptr) {
    world.groups.tables = std::make_shared<ContactTables>();
    update_tables(world.model, {}, *world.groups.tables);
    world.groups.tables->rules.set_sets(world.groups.sets);
  }
  pairs = make_pair_model(world.model, world.groups.tables, group.has_all ? nullptr : &group.objects);
  if (pairs == nullptr) return;
  pairs->filter = world.settings.contact_filter;
  if (world.settings.initial_intersections == Settings::Intersections::untangle)
    pairs->untangling_speed = world.settings.untangling_speed;
  contact = std::make_unique<SurfaceContact>(*pairs, world.kernels.pairs);
  world.workspace.look_for_tangles = true;
}

/// Updates the contact between surfaces of a group for the objects whose numbers are in `changed`.
void update_pairs(WorldData& world, SubstepGroup& group, const std::vector<int>& changed) {
  PairModel* pairs = group.has_all ? world.groups.pairs_of_all.get() : group.pair_model.get();
  if (pairs == nullptr || pairs->untangling_speed > 0) return make_pairs(world, group);
  const std::optional<PairChanges> changes = update_pair_model(world.model, changed, *pairs);
  if (!changes) return make_pairs(world, group);
  (group.has_all ? world.workspace.pairs : group.pairs)->change(*changes);
}

/// Moves to a group the contact of the earlier group with equal substeps, and updates it for objects that changed or
/// joined or left it.
void take_over_pairs(WorldData& world, SubstepGroup& group, SubstepGroup& before) {
  if (before.pair_model == nullptr) return make_pairs(world, group);
  std::vector<int> changed;
  std::set_symmetric_difference(before.objects.begin(), before.objects.end(), group.objects.begin(),
                                group.objects.end(), std::back_inserter(changed));
  for (const int o : world.groups.changed_surfaces)
    if (before.has(o) || group.has(o)) changed.push_back(o);
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  group.pair_model = std::move(before.pair_model);
  group.pairs = std::move(before.pairs);
  group.pair_model->members = group.objects;
  if (!changed.empty()) update_pairs(world, group, changed);
}

/// True if all objects have the same substeps, because the tolerance, or the record of residuals, is for all together.
bool shares_one_group(const WorldData& world) {
  return world.settings.tolerance > 0 || world.settings.record_residuals;
}

/// Finds the groups of objects with the same substeps. Their contact between surfaces is not made yet.
std::vector<SubstepGroup> find_groups(const WorldData& world, const GroupsBefore& before) {
  std::vector<SubstepGroup> found;
  if (named_substeps(world) > 0)
    found.push_back(group_of_all(world.model, named_substeps(world)));
  else
    found = make_substep_groups(world.model, &before, &world.groups.sets);
  if (named_substeps(world) > 0 || !shares_one_group(world)) return found;
  int most = 0;
  for (const SubstepGroup& group : found) most = std::max(most, group.substeps);
  found.clear();
  found.push_back(group_of_all(world.model, most));
  return found;
}

/// For each object, the index of the earlier group that had it and followed its State, or the number of groups.
std::vector<std::size_t> groups_before(const std::vector<SubstepGroup>& before, std::size_t objects) {
  std::vector<std::size_t> of_object(objects, before.size());
  for (std::size_t g = 0; g < before.size(); ++g)
    if (before[g].by_state)
      for (const int o : before[g].objects) of_object[o] = g;
  return of_object;
}

/// Finds the groups, and makes their contact between surfaces or takes it over from the groups before.
void prepare_groups(WorldData& world) {
  std::vector<SubstepGroup> before = std::move(world.groups.all);
  std::sort(world.groups.changed.begin(), world.groups.changed.end());
  world.groups.plan = planned_substeps(world.model, &world.groups.sets);
  world.groups.all = find_groups(world, {before, world.groups.changed});
  world.groups.changed.clear();
  if (before.size() == 1 && world.groups.all.size() == 1)
    return;  // still one group of all objects, whose contact stays
  world.workspace.pairs = nullptr;
  world.groups.pairs_of_all = nullptr;
  const std::vector<std::size_t> of_object = groups_before(before, world.model.objects.size());
  for (SubstepGroup& group : world.groups.all) {
    std::size_t same = before.size();
    if (group.by_state) {
      for (const int o : group.objects) same = std::min(same, of_object[o]);
    } else if (!group.has_all) {
      const auto equal = [&](const SubstepGroup& one) {
        return !one.has_all && !one.by_state && one.substeps == group.substeps;
      };
      same = static_cast<std::size_t>(std::find_if(before.begin(), before.end(), equal) - before.begin());
    }
    same < before.size() ? take_over_pairs(world, group, before[same]) : make_pairs(world, group);
  }
  world.groups.changed_surfaces.clear();
}

SystemsFor systems_for(WorldData& world, const SubstepGroup& group) {
  return {world.model, group.has_all ? nullptr : &group.objects, &world.groups.sets, &world.groups.body_meshes};
}

void make_systems(WorldData& world) {
  for (SubstepGroup& group : world.groups.all) group.systems.make(systems_for(world, group));
}

/// The sets of the objects in a frame of `dt` seconds that begins now.
std::vector<int> near_sets(const WorldData& world, double dt) {
  return world.groups.near.find(world.model, world.state, world.workspace.control, dt);
}

bool has_contact(const WorldGroups& groups) {
  return groups.pairs_of_all != nullptr ||
         std::any_of(groups.all.begin(), groups.all.end(),
                     [](const SubstepGroup& group) { return group.pairs != nullptr; });
}

/// Updates the contact between surfaces of groups that stay.
void update_surfaces(WorldData& world) {
  if (world.groups.changed_surfaces.empty()) return;
  std::vector<int> changed = std::exchange(world.groups.changed_surfaces, {});
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  for (SubstepGroup& group : world.groups.all) {
    std::vector<int> own;
    own.reserve(changed.size());
    for (const int o : changed)
      if (group.has_all || group.has(o)) own.push_back(o);
    if (!own.empty()) update_pairs(world, group, own);
  }
}

/// The fewest objects whose contact must be searched again, so that of the others any two are in one set as before, or
/// in two as before. Objects that were together and stay together are a block: of blocks that part or join, the largest
/// is kept.
std::vector<int> objects_that_parted_or_joined(const std::vector<int>& before, const std::vector<int>& now) {
  std::map<std::pair<int, int>, std::vector<int>> blocks;  // [set before, set now]
  for (std::size_t o = 0; o < now.size(); ++o) blocks[{before[o], now[o]}].push_back(static_cast<int>(o));
  std::vector<const std::pair<const std::pair<int, int>, std::vector<int>>*> largest_first;
  largest_first.reserve(blocks.size());
  for (const auto& block : blocks) largest_first.push_back(&block);
  std::stable_sort(largest_first.begin(), largest_first.end(),
                   [](const auto* a, const auto* b) { return a->second.size() > b->second.size(); });
  std::set<int> sets_before, sets_now;  // of blocks that are kept
  std::vector<int> found;
  for (const auto* block : largest_first) {
    const auto& [sets, objects] = *block;
    const bool is_kept = sets_before.count(sets.first) == 0 && sets_now.count(sets.second) == 0;
    if (!is_kept) {
      found.insert(found.end(), objects.begin(), objects.end());
      continue;
    }
    sets_before.insert(sets.first);
    sets_now.insert(sets.second);
  }
  return found;
}

/// Replaces the sets of objects. Surfaces that part or join are as if they were edited: what contact knows of them
/// holds within a set.
void change_sets(WorldData& world, std::vector<int> sets) {
  std::vector<int>& before = world.groups.sets;
  if (!before.empty() && before.size() <= sets.size()) {
    for (std::size_t o = before.size(); o < sets.size(); ++o) before.push_back(static_cast<int>(o));
    for (const int o : objects_that_parted_or_joined(before, sets)) note_surfaces(world, o);
  }
  before = std::move(sets);
  if (world.groups.tables != nullptr) world.groups.tables->rules.set_sets(before);
}

/// Sets the bounds of substeps that follow the State, whole numbers in each quarter of a frame. False if the largest is
/// less than a substep for each quarter: it is then the fixed number of the frame.
template <class Limited>
bool set_bounds(const Settings& settings, const SubstepGroup& group, const Limited& limited, GroupFrame& frame) {
  const auto up = [](int substeps) { return (substeps + quarters - 1) / quarters * quarters; };
  const auto down = [](int substeps) { return substeps / quarters * quarters; };
  const int named = up(settings.least_substeps);
  const int usual = std::max({named, group.has_sheets ? most_by_state : most_of_ropes,
                              up(group.least)});  // with what a volume of the set needs
  const int most = limited(settings.most_substeps > 0 ? settings.most_substeps : usual);
  frame.substeps = most;
  if (most < quarters) return false;
  frame.most_substeps = down(most);
  const auto within = [&](int least) { return std::min(up(least), frame.most_substeps); };
  frame.substeps = within(named > 0 ? named : std::max(group.least, least_by_state));
  if (group.hangs)
    frame.least_hanging =
        named > 0 ? frame.substeps : std::min(std::max(least_of_hanging, group.least_hanging), frame.most_substeps);
  return true;
}

/// By what factor fast colliders may increase the substeps of a frame, unless Settings::most_substeps permits more.
constexpr int default_division = 8;

GroupFrame plan(const WorldData& world, const SubstepGroup& group, double dt, std::vector<std::string>& warnings) {
  const double shortest = dt / shortest_substep;
  const auto limited = [&](int substeps) { return shortest < substeps ? static_cast<int>(shortest) : substeps; };
  GroupFrame frame{&group, group.substeps};
  int most = world.settings.most_substeps > 0 ? world.settings.most_substeps : default_division * group.substeps;
  if (group.by_state && !set_bounds(world.settings, group, limited, frame)) return frame;
  const PairModel* pairs = group.has_all ? world.groups.pairs_of_all.get() : group.pair_model.get();
  if (pairs == nullptr) return frame;
  PlannedFrame planned{world.state.time, dt, frame.substeps, limited(most), group.substeps};
  if (group.by_state) {
    const int usual = frame.most_substeps;
    planned = {world.state.time,
               dt,
               frame.substeps,
               world.settings.most_substeps > 0 ? usual : limited(most) / quarters * quarters,
               usual,
               quarters};
  }
  frame.substeps = divided_substeps(world.model, world.workspace.control, *pairs, world.state, planned, warnings);
  if (group.by_state) frame.most_substeps = std::max(frame.substeps, frame.most_substeps);
  return frame;
}

}  // namespace

void note_surfaces(WorldData& world, int number) {
  const CompiledObject& object = world.model.objects[number];
  const auto is_mesh = [](const CompiledObject& one) { return one.is_collider && one.groups != 0; };
  if (world.groups.tables != nullptr || object.self_collision || (object.collides && object.groups != 0) ||
      std::any_of(world.model.objects.begin(), world.model.objects.end(), is_mesh))
    world.groups.changed_surfaces.push_back(number);
}

void bring_up_to_date(WorldData& world) {
  if (world.groups.tables != nullptr && !world.groups.changed_surfaces.empty()) {
    update_tables(world.model, world.groups.changed_surfaces, *world.groups.tables);
    world.groups.tables->rules.set_sets(world.groups.sets);
  }
  if (world.groups.objects_changed || world.groups.all.empty()) {
    world.groups.near = NearSets(world.model);
    change_sets(world, near_sets(world, static_cast<double>(world.frame_time)));
    prepare_groups(world);
  }
  update_surfaces(world);
  if (!has_contact(world.groups)) world.groups.tables = nullptr;
  if (std::exchange(world.groups.bodies_meet_others, false) || world.groups.objects_changed) make_systems(world);
  if (!world.groups.objects_changed) return;
  for (TileScratch& tile : world.workspace.tiles)
    tile.contacts.clear();  // contacts have collider indices, which may have changed
  if (world.settings.tolerance > 0) prepare_residual(world.model, world.workspace.residual);
  world.groups.objects_changed = false;
}

void follow_distances(WorldData& world, double dt) {
  if (!world.groups.near.depend_on_distance()) return;
  std::vector<int> sets = near_sets(world, dt);
  if (sets == world.groups.sets) return;
  change_sets(world, std::move(sets));
  const bool is_one_group = named_substeps(world) > 0 || shares_one_group(world);
  const bool must_regroup = !is_one_group && planned_substeps(world.model, &world.groups.sets) != world.groups.plan;
  if (must_regroup) prepare_groups(world);
  update_surfaces(world);
  if (!has_contact(world.groups)) world.groups.tables = nullptr;
  if (must_regroup) return make_systems(world);
  for (SubstepGroup& group : world.groups.all) group.systems.follow_sets(systems_for(world, group));
}

int substeps_of(const WorldData& world, int number) {
  if (named_substeps(world) > 0) return named_substeps(world);
  if (!world.groups.objects_changed) {
    const auto has = [&](const SubstepGroup& group) { return group.has(number); };
    const SubstepGroup& group = *std::find_if(world.groups.all.begin(), world.groups.all.end(), has);
    return group.by_state ? 0 : group.substeps;
  }
  const NearSets near(world.model);
  const std::vector<int> sets =
      near.find(world.model, world.state, world.workspace.control, static_cast<double>(world.frame_time));
  const std::vector<SetSubsteps> planned = planned_substeps(world.model, &sets);
  if (!shares_one_group(world)) return planned[number].by_state ? 0 : planned[number].substeps;
  const auto fewer = [](const SetSubsteps& a, const SetSubsteps& b) { return a.substeps < b.substeps; };
  return std::max_element(planned.begin(), planned.end(), fewer)->substeps;
}

std::vector<GroupFrame> plan_frame(const WorldData& world, double dt, Report& report) {
  std::vector<GroupFrame> frames;
  for (const SubstepGroup& group : world.groups.all) {
    frames.push_back(plan(world, group, dt, report.warnings));
    // Where substeps follow the State, only those made are known, and end_group() counts them.
    if (frames.back().most_substeps == 0) report.substeps = std::max(report.substeps, frames.back().substeps);
  }
  return frames;
}

}  // namespace pliant
