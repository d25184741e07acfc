// Chooses the sweep and the substeps of a scene that leaves them open, by measurements at equal stretch
// (docs/internals/default_settings.md, "The sweep of an object").
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "matter/advice_settings.h"
#include "matter/object_facts.h"
#include "matter/surroundings.h"
#include "model/object_sets.h"
#include "model/soft_body_substeps.h"
#include "model/woven_substeps.h"
#include "pliant/scene.h"

namespace pliant {

namespace {

/// Objects with fewer particles do not need a special sweep: these are a few edges apart, and 20 substeps suffice.
constexpr std::size_t fewest_particles = 32;
constexpr const char* too_coarse = "only objects with fewer than 32 linked particles";

struct Choice {
  Sweep sweep = Sweep::tiled;
  std::string reason;
};

/// What the choice for each object starts from.
struct Given {
  const Settings& settings;
  const Surroundings& surroundings;
  OpenSets& sets;
};

/// The sweep of an object of 32 linked particles or more with a volume.
Choice choose_for_volume(const Given& given, const Object& object, std::size_t number) {
  const std::string name = "'" + object.name + "'";
  const double frame = given.surroundings.frame_time;
  if (strain_of_inflated(object) == 0) return {Sweep::chains, name + ", which has a volume"};
  if (!can_follow_volume(object, frame / substeps_of_volumes))
    return {Sweep::tiled, name + ", which is inflated, though its edges resist that"};
  const int substeps = given.sets.substeps_of(number);
  if (!can_follow_volume(object, frame / substeps))
    return {Sweep::tiled,
            name + ", which is inflated, for which " + std::to_string(substeps) + " substeps of chains are too few"};
  return {Sweep::chains, name + ", which has a volume"};
}

Choice choose(const Given& given, const Object& object, std::size_t number) {
  const std::string name = "'" + object.name + "'";
  const double gravity = given.surroundings.gravity;
  if (given.settings.iterations > 1) return {Sweep::tiled, "more than one iteration"};
  if (is_soft_body(object)) return {Sweep::tiled, name + ", a soft body"};
  const std::size_t particles = linked_particles(object);
  // A heavy body stretches even a short rope, unless the rope is solved with the body's inertia, which only chains are.
  const bool is_tied = particles > 0 && has_ties(object);
  if (has_changing_lengths(object)) return {Sweep::chains, name + ", whose rest lengths change"};
  if (particles > 0 && is_sewn(object)) return {Sweep::chains, name + ", whose particles are sewn together"};
  if (is_coarse(particles) && is_tied) return {Sweep::chains, name + ", which is tied to bodies"};
  if (is_coarse(particles)) return {Sweep::tiled, too_coarse};
  if (object.volume) return choose_for_volume(given, object, number);
  if (is_woven(object)) return {Sweep::chains, name + ", woven cloth, whose shear tethers and multigrid do not see"};
  // Neither tethers nor multigrid know of bending, which demands more substeps than they need for stretch.
  const bool is_stiff = is_stiff_sheet(object, gravity), is_in_rows = is_regular(object);
  const bool touches = can_touch(given.surroundings, object, number);
  // Tethers would pull tied particles off their bodies.
  if (!is_stiff && !is_tied && is_in_rows && may_be_tethered(object, gravity) && (!touches || !lies_on_pins(object)))
    return {Sweep::tethered_chains,
            name + ", which hangs from pins or attachments and has its springs in straight rows"};
  if (touches) return {Sweep::chains, name + ", a surface that can touch itself or others"};
  if (is_stiff) return {Sweep::chains, name + ", a sheet whose bending length is more than a quarter of its size"};
  if (is_in_rows) return {Sweep::chains, name + ", whose springs lie in straight rows"};
  if (is_tied) return {Sweep::chains, name + ", which is tied to bodies"};
  // Multigrid would be faster at equal stretch, but cloth that should slide over a collider sticks with it.
  if (can_meet_collider(given.surroundings, object)) return {Sweep::chains, name + ", which can meet a collider"};
  return {Sweep::multigrid,
          "irregular cloth or rope that meets nothing, the largest of " + std::to_string(particles) + " particles"};
}

/// The sweep of one object: its own, else that of the settings, else the one chosen for it.
Choice choice_of(const Given& given, const Object& object, std::size_t number) {
  if (object.sweep != Sweep::automatic) return {object.sweep, {}};
  if (given.settings.sweep != Sweep::automatic) return {given.settings.sweep, {}};
  return choose(given, object, number);
}

/// Counts the objects of each sweep. Objects too small for sweeps to differ are ignored; they use the sweep of the
/// others.
struct SweepsInUse {
  struct Use {
    std::string first;  ///< name of the first object
    int objects = 0;
  };
  std::map<Sweep, Use> uses;
  std::string reason = too_coarse;  ///< reason of the largest object with multigrid, else of the first object
  std::size_t particles = 0;        ///< number of particles of the object that `reason` concerns

  void add(const Object& object, const Choice& choice) {
    Use& use = uses[choice.sweep];
    if (use.objects++ == 0) use.first = object.name;
    const bool is_larger = choice.sweep == Sweep::multigrid && object.positions.size() > particles;
    if (reason != too_coarse && !is_larger) return;
    reason = choice.reason;
    particles = object.positions.size();
  }

  /// The sweep that all objects have; `automatic` if they differ; `of_none` if there are no objects.
  Sweep common(Sweep of_none) const {
    return uses.empty() ? of_none : uses.size() == 1 ? uses.begin()->first : Sweep::automatic;
  }

  std::string in_words() const {
    if (uses.size() < 2) return reason;
    std::string text;
    for (const auto& [sweep, use] : uses)
      text += (text.empty() ? "'" : ", '") + use.first + "'" +
              (use.objects > 1 ? " and " + std::to_string(use.objects - 1) + " more" : "") + " by '" +
              sweep_name(sweep) + "'";
    return text;
  }
};

/// The sweep of an object that is too small for sweeps to differ: that of the others if it needs no more substeps. But
/// tethers would hold back an object that is meant to stretch, or whose pins move apart.
Sweep sweep_of_coarse(const Object& object, double gravity, Sweep common) {
  if (common == Sweep::tethered_chains && has_fixed(object) && !may_be_tethered(object, gravity)) return Sweep::chains;
  if (is_woven(object) && (common == Sweep::multigrid || solves_chains(common)))
    return Sweep::chains;  // others hold back shear
  return common == Sweep::multigrid || solves_chains(common) ? common : Sweep::tiled;
}

struct Choices {
  std::vector<Sweep> sweeps;  ///< sweep of each object
  SweepsInUse used;
};

Choices choices_of(const Scene& scene, const Settings& settings) {
  Choices out;
  std::vector<std::size_t> coarse;
  const Surroundings surroundings = surroundings_of(scene, settings);
  OpenSets sets(surroundings, settings);
  for (const Object& object : scene.objects) {
    const Choice choice = choice_of({settings, surroundings, sets}, object, out.sweeps.size());
    if (choice.reason != too_coarse)
      out.used.add(object, choice);
    else
      coarse.push_back(out.sweeps.size());
    out.sweeps.push_back(choice.sweep);
  }
  const Sweep common = out.used.common(Sweep::tiled);
  for (const std::size_t o : coarse) {
    out.sweeps[o] = sweep_of_coarse(scene.objects[o], surroundings.gravity, common);
    if (common == Sweep::tethered_chains && out.sweeps[o] != common)
      out.used.add(scene.objects[o], {out.sweeps[o], too_coarse});
  }
  return out;
}

}  // namespace

bool is_coarse(std::size_t particles) { return particles < fewest_particles; }

bool has_stiff_sheet(const Scene& scene) {
  const double gravity = magnitude(scene.gravity);
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    return linked_particles(object) > 0 && is_stiff_sheet(object, gravity);
  });
}

Sweep chosen_sweep(const Scene& scene, int object, std::string* reason) {
  return chosen_sweep(scene, scene.settings, object, reason);
}

Sweep chosen_sweep(const Scene& scene, const Settings& settings, int object, std::string* reason) {
  const Surroundings surroundings = surroundings_of(scene, settings);
  OpenSets sets(surroundings, settings);
  const auto number = static_cast<std::size_t>(object);
  const Choice choice = choice_of({settings, surroundings, sets}, scene.objects[number], number);
  if (reason != nullptr) *reason = choice.reason;
  if (choice.reason != too_coarse) return choice.sweep;
  return choices_of(scene, settings).sweeps[number];
}

Sweep chosen_sweep(const Object& object, const Surroundings& surroundings, const Settings& settings,
                   const std::vector<Sweep>& others) {
  OpenSets sets(surroundings, settings);
  const Choice choice = choice_of({settings, surroundings, sets}, object, others.size());
  if (choice.reason != too_coarse) return choice.sweep;
  SweepsInUse used;
  for (const Sweep sweep : others)
    if (sweep != Sweep::automatic) used.add({}, {sweep, {}});
  return sweep_of_coarse(object, surroundings.gravity, used.common(Sweep::tiled));
}

std::vector<Sweep> chosen_sweeps(const Scene& scene, const Settings& settings) {
  return choices_of(scene, settings).sweeps;
}

namespace {

/// The substeps of each object's set, if the settings name none. With a tolerance or recorded residuals, all objects
/// have the largest. 0 where they follow the State.
std::vector<int> substeps_of_objects(const Scene& scene, const Settings& settings, const std::vector<Sweep>& sweeps) {
  std::vector<SetMember> members;
  const double gravity = magnitude(scene.gravity);
  const bool is_blown = blows(scene.wind, scene.forces);
  for (std::size_t o = 0; o < sweeps.size(); ++o)
    members.push_back(member_of(
        scene.objects[o], own_substeps(scene.objects[o], sweeps[o], is_blown, static_cast<double>(scene.frame_time)),
        substep_rule(scene.objects[o], sweeps[o], gravity), static_cast<double>(scene.frame_time)));
  for (const MeshCollider& collider : scene.mesh_colliders) members.push_back(member_of(collider));
  std::vector<SetSubsteps> sets = substeps_of_sets(members);
  sets.resize(scene.objects.size());
  const bool is_one_set = settings.tolerance > 0 || settings.record_residuals;
  int most = 0;
  for (const SetSubsteps& set : sets) most = std::max(most, set.substeps);
  std::vector<int> substeps;
  substeps.reserve(sets.size());
  for (const SetSubsteps& set : sets) substeps.push_back(is_one_set ? most : set.by_state ? 0 : set.substeps);
  return substeps;
}

}  // namespace

std::vector<int> chosen_substeps(const Scene& scene) { return chosen_substeps(scene, scene.settings); }

std::vector<int> chosen_substeps(const Scene& scene, const Settings& settings) {
  if (settings.substeps != 0) return std::vector<int>(scene.objects.size(), settings.substeps);
  return substeps_of_objects(scene, settings, chosen_sweeps(scene, settings));
}

Settings chosen_settings(const Scene& scene, std::string* reason) {
  return chosen_settings(scene, scene.settings, reason);
}

Settings chosen_settings(const Scene& scene, Settings settings, std::string* reason) {
  const Choices choices = choices_of(scene, settings);
  const SweepsInUse& used = choices.used;
  const bool is_open = settings.sweep == Sweep::automatic;
  const Sweep common = used.common(is_open ? Sweep::tiled : settings.sweep);
  if (is_open) settings.sweep = common;
  if (is_open && reason != nullptr) *reason = used.in_words();
  if (settings.substeps != 0) return settings;
  const std::vector<int> substeps = substeps_of_objects(scene, settings, choices.sweeps);
  if (substeps.empty())
    settings.substeps = common == Sweep::multigrid ? substeps_of_multigrid : substeps_of_others;
  else if (std::all_of(substeps.begin(), substeps.end(), [&](int other) { return other == substeps.front(); }))
    settings.substeps = substeps.front();
  return settings;
}

}  // namespace pliant
