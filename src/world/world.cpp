// Makes a World from a Scene, and steps it.
#include "pliant/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "inspect/inspect_scene.h"
#include "matter/advice_settings.h"
#include "solver/divide.h"
#include "solver/step.h"
#include "solver/substep_law.h"
#include "world/implementation.h"

namespace pliant {

namespace {

const Kernels& kernels_for(const Settings& settings) {
  return settings.sweep == Sweep::sequential ? kernels_sequential() : pick_kernels(settings.isa);
}

/// Sets the bounds of substeps that follow the State, whole numbers in each quarter of a frame. False if the largest is less than a
/// substep for each quarter: it is then the fixed number of the frame.
template <class Limited>
bool set_bounds(const Settings& settings, const SubstepGroup& group, const Limited& limited, GroupFrame& frame) {
  const auto up = [](int substeps) { return (substeps + quarters - 1) / quarters * quarters; };
  const auto down = [](int substeps) { return substeps / quarters * quarters; };
  const int named = up(settings.least_substeps);
  const int most = limited(settings.most_substeps > 0 ? settings.most_substeps : std::max(named, most_by_state));
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

}  // namespace

World::Implementation::Implementation(const Scene& scene, const Settings& given, const Settings& with, Scene* given_away)
    : settings(with),
      departs(departures(scene, given, with)),
      sweep_is_open(given.sweep == Sweep::automatic),
      substeps_are_open(given.substeps == 0),
      executor(with.threads),
      kernels(kernels_for(with)) {
  model.gravity = scene.gravity;
  model.wind = scene.wind;
  model.forces = scene.forces;
  model.pairs = scene.pairs;
  model.colliders = scene.colliders;
  for (int c = 0; c < static_cast<int>(scene.colliders.size()); ++c) collider_ids.add(c);
  const std::vector<Sweep> sweeps = chosen_sweeps(scene, with);  // the sweep of each depends on all objects
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const CompileOptions options = compile_options(sweeps[o]);
    object_ids.add(model.add(given_away != nullptr ? compile(std::exchange(given_away->objects[o], {}), options)
                                                   : compile(scene.objects[o], options)));
  }
  for (const MeshCollider& collider : scene.mesh_colliders)
    mesh_collider_ids.add(add_to_model(collider, compile(collider)));
  state = initial_state(model);
  for (int number = 0; number < static_cast<int>(model.objects.size()); ++number) prepare(number);
  bring_up_to_date();
}

int World::Implementation::substeps_of(int number) const {
  if (named_substeps() > 0) return named_substeps();
  const auto find = [&](const std::vector<SubstepGroup>& all) {
    const auto has = [&](const SubstepGroup& group) { return group.has_all || group.has[number] != 0; };
    const SubstepGroup& group = *std::find_if(all.begin(), all.end(), has);
    return group.by_state ? 0 : group.substeps;
  };
  return objects_changed ? find(find_groups()) : find(groups);
}

GroupFrame World::Implementation::plan(const SubstepGroup& group, double dt, std::vector<std::string>& warnings) const {
  const double shortest = dt / shortest_substep;
  const auto limited = [&](int substeps) { return shortest < substeps ? static_cast<int>(shortest) : substeps; };
  GroupFrame frame{&group, group.substeps};
  int most = settings.most_substeps > 0 ? settings.most_substeps : default_division * group.substeps;
  if (group.by_state && !set_bounds(settings, group, limited, frame)) return frame;
  const PairModel* pairs = group.has_all ? pair_model.get() : group.pair_model.get();
  if (pairs == nullptr) return frame;
  PlannedFrame planned{state.time, dt, frame.substeps, limited(most), group.substeps};
  if (group.by_state) {
    const int usual = frame.most_substeps;
    planned = {state.time,     dt,
               frame.substeps, settings.most_substeps > 0 ? usual : limited(most) / quarters * quarters,
               usual,          quarters};
  }
  frame.substeps = divided_substeps(model, workspace.control, *pairs, state, planned, warnings);
  if (group.by_state) frame.most_substeps = std::max(frame.substeps, frame.most_substeps);
  return frame;
}

std::vector<GroupFrame> World::Implementation::plan_frame(double dt, Report& report) {
  std::vector<GroupFrame> frames;
  for (const SubstepGroup& group : groups) {
    frames.push_back(plan(group, dt, report.warnings));
    // Where substeps follow the State, only those made are known, and end_group() counts them.
    if (frames.back().most_substeps == 0) report.substeps = std::max(report.substeps, frames.back().substeps);
  }
  return frames;
}

World::World(const Scene& scene) {
  refuse_grave(scene);
  self_ = std::make_unique<Implementation>(scene, scene.settings, chosen_settings(scene));
}

World::World(const Scene& scene, const Settings& settings) {
  {
    Scene checked = scene;  // a copy, freed before objects are compiled
    checked.settings = settings;
    refuse_grave(checked);
  }
  self_ = std::make_unique<Implementation>(scene, settings, chosen_settings(scene, settings));
}

World::World(Scene&& scene) {
  refuse_grave(scene);
  self_ = std::make_unique<Implementation>(scene, scene.settings, chosen_settings(scene), &scene);
}

World::World(Scene&& scene, const Settings& settings) {
  scene.settings = settings;
  refuse_grave(scene);
  self_ = std::make_unique<Implementation>(scene, settings, chosen_settings(scene), &scene);
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Report World::step(float dt) {
  Report report;
  report.frame = self_->state.frame;
  report.time = self_->state.time;
  report.worst_overstretch = self_->overstretch.worst();
  self_->bring_up_to_date();
  if (!(dt > 0) || !std::isfinite(dt) || double(dt) / self_->groups.back().substeps < shortest_substep) {
    report.warnings.push_back("a time step must be finite and above zero, its substeps 1e-12 s or more; nothing moved");
    return report;
  }
  if (self_->stopped) {
    report.nonfinite = NonFinite{"", "the world stopped at an earlier step", report.frame, 0};
    return report;
  }
  if (self_->stop != nullptr && *self_->stop) {
    report.stopped = true;
    return report;
  }
  self_->begin_control(dt);
  const std::vector<GroupFrame> groups = self_->plan_frame(dt, report);
  self_->stopped = true;  // if the step throws (a user's force field may), it stays true
  pliant::step({self_->model, self_->state, self_->workspace, self_->executor, self_->kernels, groups.back().substeps,
                self_->settings.iterations, self_->settings.sweep_options, self_->settings.record_residuals, self_->stop,
                self_->settings.separate_phases, static_cast<double>(self_->settings.tolerance), groups,
                &self_->overstretch.meter()},
               dt, report);
  self_->stopped = report.nonfinite.has_value();
  if (self_->stopped || report.stopped) self_->forget_multipliers(!self_->stopped);
  self_->end_control(report.stopped);
  if (report.overstretch) {
    report.overstretch = self_->with_slot(*report.overstretch);
    self_->overstretch.add(*report.overstretch, report.frame);
  }
  report.worst_overstretch = self_->overstretch.worst();
  if (self_->workspace.contact_log != nullptr) self_->make_events();
  if (self_->settings.measure) {
    report.residuals = residuals();
    report.stretch = measure_stretch(self_->model, self_->state, self_->ratios);
  }
  return report;
}

void World::stop_when(const std::atomic<bool>* flag) { self_->stop = flag; }

const State& World::state() const { return self_->state; }

const Settings& World::settings() const { return self_->settings; }
std::string World::isa() const { return self_->kernels.isa; }
int World::threads() const { return self_->executor.threads(); }

}  // namespace pliant
