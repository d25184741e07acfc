#include "matter/advice_settings.h"
#include "constraints/registry.h"
#include "matter/object_facts.h"
#include "model/object_sets.h"
#include "model/soft_body_substeps.h"
#include "model/woven_substeps.h"

#include <algorithm>
#include <utility>

namespace pliant {

namespace {

bool is_rigid(const Object& object) {
  return std::all_of(object.constraints.begin(), object.constraints.end(), [](const ConstraintGroup& group) {
    const auto is_zero = [](float alpha) { return alpha == 0; };
    return !is_length(group.type) ||
           (group.stiffness.kind == Stiffness::Kind::compliance && group.stiffness.value == 0 &&
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

bool may_meet_collider(const Scene& scene) {
  const auto meets = [&](const MeshCollider& collider) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
      return (object.groups & collider.mask) != 0 && (collider.groups & object.mask) != 0;
    });
  };
  return !scene.colliders.empty() || std::any_of(scene.mesh_colliders.begin(), scene.mesh_colliders.end(), meets);
}

/// "a", "a and b", or "a, b and c".
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

bool has_lengths(const Object& object) {
  return std::any_of(object.constraints.begin(), object.constraints.end(),
                     [](const ConstraintGroup& group) { return is_length(group.type) && !group.particles.empty(); });
}

bool hangs_by_lengths(const Object& object) { return !object.pins.empty() && has_lengths(object); }

/// True if a soft body has no lengths, or no object has any: what corrects lengths does nothing for it.
bool lacks_lengths(const Scene& scene) {
  const auto is_without = [](const Object& object) { return is_soft_body(object) && !has_lengths(object); };
  return std::none_of(scene.objects.begin(), scene.objects.end(), has_lengths) ||
         std::any_of(scene.objects.begin(), scene.objects.end(), is_without);
}

}  // namespace

bool may_tether(const Scene& scene) {
  const auto hangs_and_stretches = [](const Object& object) {
    const bool stretches = !is_rigid(object) || is_soft_body(object) || is_woven(object);
    return (!object.pins.empty() && stretches) || has_changing_lengths(object);
  };
  return std::any_of(scene.objects.begin(), scene.objects.end(), hangs_by_lengths) &&
         std::none_of(scene.objects.begin(), scene.objects.end(), hangs_and_stretches);
}

std::vector<Sweep> better_sweeps(const Scene& scene) {
  if (lacks_lengths(scene)) return {};
  std::vector<Sweep> better{Sweep::chains, Sweep::multigrid};
  if (chosen_settings(scene, left_open(scene.settings)).sweep == Sweep::multigrid) std::swap(better[0], better[1]);
  better.erase(std::remove(better.begin(), better.end(), scene.settings.sweep), better.end());
  const bool changes = std::any_of(scene.objects.begin(), scene.objects.end(), has_changing_lengths);
  const bool shears = std::any_of(scene.objects.begin(), scene.objects.end(), is_woven);
  if (changes || shears || has_stiff_sheet(scene) || movers_may_touch(scene) || may_meet_collider(scene))
    better.erase(std::remove(better.begin(), better.end(), Sweep::multigrid), better.end());
  return better;
}

Settings left_open(Settings settings) {
  settings.sweep = Sweep::automatic;
  settings.substeps = settings.least_substeps = settings.most_substeps = 0;
  return settings;
}

std::string departures(const Scene& scene, const Settings& given, const Settings& chosen) {
  std::vector<std::string> named;
  const auto add = [&](const char* name, bool is_named) {
    if (is_named) named.push_back("\"" + std::string(name) + "\"");
  };
  add("sweep", given.sweep != Sweep::automatic);
  add("substeps", given.substeps != 0);
  const bool has_bounds = given.substeps == 0 && (given.least_substeps != 0 || given.most_substeps != 0);
  if (named.empty() && !has_bounds) return {};
  const Settings by_default = chosen_settings(scene, left_open(given));
  const bool departs = chosen.sweep != by_default.sweep || chosen.substeps != by_default.substeps;
  add("least_substeps", has_bounds && given.least_substeps != 0);
  add("most_substeps", has_bounds && given.most_substeps != 0);
  // Bounds have no effect on a number that the default fixes.
  return departs || (has_bounds && by_default.substeps == 0) ? listed(named) : std::string();
}

std::string in_json(const Settings& wanted, const Settings& own) {
  std::string members;
  const auto add = [&](const std::string& member) { members += (members.empty() ? "" : ", ") + member; };
  const bool has_bounds = wanted.substeps == 0 && own.substeps == 0;
  if (has_bounds && wanted.least_substeps != own.least_substeps)
    add("\"least_substeps\": " + std::to_string(wanted.least_substeps));
  if (has_bounds && wanted.most_substeps != own.most_substeps)
    add("\"most_substeps\": " + std::to_string(wanted.most_substeps));
  // The sweep decides the defaults of what the scene leaves open, so such settings are written out.
  if (wanted.substeps != own.substeps || wanted.sweep != own.sweep)
    add("\"substeps\": " + std::to_string(most_substeps_of(wanted)));
  if (wanted.sweep != own.sweep) add("\"sweep\": \"" + sweep_name(wanted.sweep) + "\"");
  if (wanted.sweep_options.tethers && !own.sweep_options.tethers) add("\"sweep_options\": {\"tethers\": true}");
  return "{" + members + "}";
}

}  // namespace pliant
