#include "matter/advice_settings.h"
#include "constraints/registry.h"
#include "model/object_sets.h"

#include <algorithm>
#include <utility>

namespace pliant {

namespace {

bool is_rigid(const Object& object) {
  return std::all_of(object.constraints.begin(), object.constraints.end(), [](const ConstraintGroup& group) {
    const auto is_zero = [](float alpha) { return alpha == 0; };
    return !is_length(group.type) || (group.stiffness.kind == Stiffness::Kind::compliance && group.stiffness.value == 0 &&
                                      std::all_of(group.compliances.begin(), group.compliances.end(), is_zero));
  });
}

bool may_touch(const Object& a, const Object& b) {
  return a.collides && b.collides && (a.groups & b.mask) != 0 && (b.groups & a.mask) != 0;
}

/// True if dynamic objects can touch themselves or each other. Mesh colliders do not count.
bool movers_may_touch(const Scene& scene) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].self_collision) return true;
    for (std::size_t j = 0; j < i; ++j)
      if (may_touch(scene.objects[i], scene.objects[j])) return true;
  }
  return false;
}

bool has_pins(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [](const Object& o) { return !o.pins.empty(); });
}

}  // namespace

bool may_tether(const Scene& scene) {
  const auto hangs_and_stretches = [](const Object& object) { return !object.pins.empty() && !is_rigid(object); };
  return has_pins(scene) && std::none_of(scene.objects.begin(), scene.objects.end(), hangs_and_stretches);
}

std::vector<Sweep> better_sweeps(const Scene& scene) {
  std::vector<Sweep> better{Sweep::chains, Sweep::multigrid};
  if (chosen_settings(scene, left_open(scene.settings)).sweep == Sweep::multigrid) std::swap(better[0], better[1]);
  better.erase(std::remove(better.begin(), better.end(), scene.settings.sweep), better.end());
  if (has_stiff_sheet(scene) || movers_may_touch(scene))
    better.erase(std::remove(better.begin(), better.end(), Sweep::multigrid), better.end());
  return better;
}

Settings left_open(Settings settings) {
  settings.sweep = Sweep::automatic;
  settings.substeps = 0;
  return settings;
}

bool departs_from_default(const Scene& scene, const Settings& given, const Settings& chosen) {
  if (given.sweep == Sweep::automatic && given.substeps == 0) return false;
  const Settings by_default = chosen_settings(scene, left_open(given));
  return chosen.sweep != by_default.sweep || chosen.substeps != by_default.substeps;
}

std::string in_json(const Settings& wanted, const Settings& own) {
  std::string members;
  const auto add = [&](const std::string& member) { members += (members.empty() ? "" : ", ") + member; };
  // The sweep decides the defaults of what the scene leaves open, so such settings are written out.
  if (wanted.substeps != own.substeps || wanted.sweep != own.sweep)
    add("\"substeps\": " + std::to_string(most_substeps_of(wanted)));
  if (wanted.sweep != own.sweep) add("\"sweep\": \"" + sweep_name(wanted.sweep) + "\"");
  if (wanted.sweep_options.tethers && !own.sweep_options.tethers) add("\"sweep_options\": {\"tethers\": true}");
  return "{" + members + "}";
}

}  // namespace pliant
