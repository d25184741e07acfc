#include "solver/substep_group.h"

#include <algorithm>
#include <utility>

#include "model/object_sets.h"

namespace pliant {

namespace {

SetMember member_of(const CompiledObject& object) {
  if (object.particles == 0) return {};  // the object was removed
  return {object.groups, object.mask, object.collides && !object.is_collider, object.is_collider, object.own_substeps};
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

SubstepGroup group_of(const Model& model, const std::vector<int>& of_object, int substeps) {
  SubstepGroup group;
  group.substeps = substeps;
  group.has_all = false;
  for (std::size_t o = 0; o < of_object.size(); ++o) {
    const CompiledObject& object = model.objects[o];
    const bool is_in = object.particles > 0 && of_object[o] == substeps;
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
  return group;
}

}  // namespace

SubstepGroup group_of_all(int substeps) {
  SubstepGroup group;
  group.substeps = substeps;
  return group;
}

std::vector<SubstepGroup> make_substep_groups(const Model& model) {
  std::vector<SetMember> members;
  for (const CompiledObject& object : model.objects) members.push_back(member_of(object));
  std::vector<int> of_object = substeps_of_sets(members), numbers;
  for (const int substeps : of_object)
    if (substeps > 0) numbers.push_back(substeps);
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<SubstepGroup> groups;
  if (numbers.size() < 2) {
    groups.push_back(group_of_all(numbers.empty() ? substeps_of_others : numbers.front()));
    return groups;
  }
  for (int& substeps : of_object) substeps = std::max(substeps, numbers.front());
  for (const int substeps : numbers) groups.push_back(group_of(model, of_object, substeps));
  return groups;
}

}  // namespace pliant
