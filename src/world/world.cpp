// Makes a World from a Scene, and steps it.
#include "pliant/world.h"

#include <cmath>
#include <string>
#include <utility>

#include "inspect/inspect_scene.h"
#include "matter/advice_settings.h"
#include "solver/step.h"
#include "solver/sweeps/sweep.h"
#include "world/advice.h"
#include "world/control.h"
#include "world/events.h"
#include "world/flow.h"
#include "world/groups.h"
#include "world/jumps.h"
#include "world/object_store.h"
#include "world/overlaps.h"
#include "world/rest.h"
#include "world/resting_grains.h"
#include "world/soaking.h"
#include "world/tearing.h"
#include "world/touching_starts.h"

namespace pliant {

namespace {

const Kernels& kernels_for(const Settings& settings) {
  return settings.sweep == Sweep::sequential ? kernels_sequential() : pick_kernels(settings.isa);
}

}  // namespace

WorldData::WorldData(const Scene& scene, const Settings& given, const Settings& with, Scene* given_away)
    : settings(with),
      frame_time(scene.frame_time),
      open{given.sweep == Sweep::automatic, given.substeps == 0, departures(scene, given, with)},
      executor(with.threads),
      kernels(kernels_for(with)) {
  warnings = warnings_of_starts_in_solids(scene);
  for (std::string& warning : warnings_of_soft_bodies(scene, given)) warnings.push_back(std::move(warning));
  for (std::string& warning : warnings_of_woven(scene, given)) warnings.push_back(std::move(warning));
  for (std::string& warning : warnings_of_hinges(scene, given)) warnings.push_back(std::move(warning));
  for (std::string& warning : warnings_of_multigrid(scene, given)) warnings.push_back(std::move(warning));
  for (std::string& warning : warnings_of_plates(scene, given)) warnings.push_back(std::move(warning));
  for (std::string& warning : warnings_of_masses(scene)) warnings.push_back(std::move(warning));
  model.gravity = scene.gravity;
  model.wind = scene.wind;
  model.forces = scene.forces;
  model.pairs = scene.pairs;
  model.colliders = scene.colliders;
  for (int c = 0; c < static_cast<int>(scene.colliders.size()); ++c) ids.colliders.add(c);
  const std::vector<Sweep> sweeps = chosen_sweeps(scene, with);  // the sweep of each depends on all objects
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    keep_description(*this, static_cast<int>(o), &scene.objects[o]);
    const CompileOptions options = compile_options(*this, sweeps[o]);
    ids.objects.add(model.add(given_away != nullptr ? compile(std::exchange(given_away->objects[o], {}), options)
                                                    : compile(scene.objects[o], options)));
  }
  for (const MeshCollider& collider : scene.mesh_colliders)
    ids.mesh_colliders.add(add_to_model(*this, collider, compile(collider)));
  open_liquids(*this);
  state = initial_state(model);
  part_touching_starts(*this);
  for (int number = 0; number < static_cast<int>(model.objects.size()); ++number) prepare_object(*this, number);
  keep_flowed(*this);
  follow_rest_factors(*this, 0);
  mark_overlaps(*this, -1);
  bring_up_to_date(*this);
}

CompileOptions compile_options(const WorldData& world, Sweep sweep) {
  CompileOptions options;
  options.sweep = sweep;
  const int substeps = named_substeps(world) > 0 ? named_substeps(world)
                                                 : substeps_of_others;  // own_substeps() of objects with PBD stiffness
  options.passes = substeps * world.settings.iterations * sweep_method(sweep).passes;
  options.iterations = world.settings.iterations;
  options.names_substeps = named_substeps(world) > 0;
  options.keeps_energy = world.settings.integrator == Settings::Integrator::energy;
  options.chain_softness = world.settings.sweep_options.chain_softness;
  options.tethers = world.settings.sweep_options.tethers;
  options.tether_slack = world.settings.sweep_options.tether_slack;
  options.air = world.model.wind.air_density > 0;
  options.gravity = length(world.model.gravity);
  options.is_blown = blows(world.model.wind, world.model.forces);
  options.frame_time = static_cast<double>(world.frame_time);
  return options;
}

void forget_multipliers(WorldData& world, bool only_of_last) {
  for (std::size_t o = 0; o < world.workspace.multipliers.size(); ++o) {
    auto& of_pools = world.workspace.multipliers[o];
    for (std::size_t pool = 0; pool < of_pools.size(); ++pool) {
      const bool is_of_last =
          world.workspace.stores_in_last[o] != 0 || world.workspace.pointers_before_last[o][pool] == nullptr;
      if (!only_of_last || is_of_last) std::fill(of_pools[pool].begin(), of_pools[pool].end(), 0.f);
    }
  }
  if (!only_of_last)
    std::fill(world.workspace.volume_multipliers.begin(), world.workspace.volume_multipliers.end(), 0.);
}

World::World(const Scene& scene) {
  refuse_grave(scene);
  data_ = std::make_unique<WorldData>(scene, scene.settings, chosen_settings(scene));
}

World::World(const Scene& scene, const Settings& settings) {
  {
    Scene checked = scene;  // a copy, freed before objects are compiled
    checked.settings = settings;
    refuse_grave(checked);
  }
  data_ = std::make_unique<WorldData>(scene, settings, chosen_settings(scene, settings));
}

World::World(Scene&& scene) {
  refuse_grave(scene);
  data_ = std::make_unique<WorldData>(scene, scene.settings, chosen_settings(scene), &scene);
}

World::World(Scene&& scene, const Settings& settings) {
  scene.settings = settings;
  refuse_grave(scene);
  data_ = std::make_unique<WorldData>(scene, settings, chosen_settings(scene), &scene);
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Report World::step(float dt) {
  Report report;
  report.frame = data_->state.frame;
  report.time = data_->state.time;
  report.worst_overstretch = data_->overstretch.worst();
  report.worst_estimates = data_->convergence.worst();
  bring_up_to_date(*data_);
  if (!(dt > 0) || !std::isfinite(dt) || double(dt) / data_->groups.all.back().substeps < shortest_substep) {
    report.warnings.push_back("a time step must be finite and above zero, its substeps 1e-12 s or more; nothing moved");
    return report;
  }
  if (data_->stopped) {
    report.nonfinite = NonFinite{"", "the world stopped at an earlier step", report.frame, 0};
    return report;
  }
  if (data_->stop != nullptr && *data_->stop) {
    report.stopped = true;
    return report;
  }
  report.warnings = std::exchange(data_->warnings, {});
  const double start = data_->state.time;
  let_flow(*data_, static_cast<double>(dt), report.flow);
  follow_rest_factors(*data_, data_->state.time + static_cast<double>(dt));
  follow_motors(*data_, data_->state.time + static_cast<double>(dt));
  begin_control(*data_, dt);
  place_what_jumps(*data_, static_cast<double>(dt), report.warnings);
  const Resting resting = begin_rest(*data_, static_cast<double>(dt));
  follow_distances(*data_, static_cast<double>(dt));
  const std::vector<GroupFrame> groups = plan_frame(*data_, dt, report);
  data_->stopped = true;  // if the step throws (a user's force field may), it stays true
  pliant::step(
      {data_->model, data_->state, data_->workspace, data_->executor, data_->kernels, groups.back().substeps,
       data_->settings.iterations, data_->settings.sweep_options, data_->settings.record_residuals, data_->stop,
       data_->settings.separate_phases, static_cast<double>(data_->settings.tolerance), groups,
       &data_->overstretch.meter(), data_->settings.sleep, data_->settings.integrator == Settings::Integrator::energy,
       changes_in_substeps(data_->model) ? &data_->model.objects : nullptr, &data_->convergence.meter()},
      dt, report);
  keep_flowed(*data_);
  forget_overlaps(*data_);
  for (JointBreak& broken : report.broken_joints) broken.object = data_->ids.objects.id_of(broken.object.slot);
  if (!report.broken_joints.empty()) data_->groups.bodies_meet_others = true;
  data_->stopped = report.nonfinite.has_value();
  const double elapsed = data_->state.time - start;  // less than dt if the step was stopped
  report.sleeping_grains = end_rest(*data_, elapsed, resting);
  if (!data_->stopped) soak(*data_, elapsed, report.flow);
  report.flow.present = count_present(*data_);
  if (data_->stopped || report.stopped) forget_multipliers(*data_, !data_->stopped);
  end_control(*data_, report.stopped);
  report.widest_tie.object =
      report.widest_tie.body < 0 ? ObjectId() : data_->ids.objects.id_of(report.widest_tie.object.slot);
  if (!is_tolerable(report.widest_tie))
    report.warnings.push_back(words_of(report.widest_tie, data_->object(report.widest_tie.object)));
  if (report.overstretch) {
    report.overstretch = with_slot(*data_, *report.overstretch);
    data_->overstretch.add(*report.overstretch, report.frame);
    report.estimates = data_->convergence.add(report, data_->ids.objects, [&](int number) {
      return static_cast<int>(
          std::lround(static_cast<double>(dt) / static_cast<double>(data_->workspace.last_h[number])));
    });
  }
  report.worst_overstretch = data_->overstretch.worst();
  report.worst_estimates = data_->convergence.worst();
  if (data_->workspace.contact_log != nullptr) make_events(*data_);
  if (data_->settings.measure) {
    report.residuals = measure().residuals();
    report.stretch = measure().stretch();
  }
  if (!data_->stopped && !report.stopped) tear_objects(*data_, report);
  return report;
}

void World::stop_when(const std::atomic<bool>* flag) { data_->stop = flag; }

const State& World::state() const { return data_->state; }

const Settings& World::settings() const { return data_->settings; }
std::string World::isa() const { return data_->kernels.isa; }
int World::threads() const { return data_->executor.threads(); }

}  // namespace pliant
