// A World: a compiled Scene, its State, and the step.
#include "pliant/world.h"

#include <cmath>
#include <utility>

#include "inspect/inspect_scene.h"
#include "matter/advice_settings.h"
#include "solver/divide.h"
#include "solver/step.h"
#include "world/implementation.h"

namespace pliant {

namespace {

const Kernels& kernels_for(const Settings& settings) {
  return settings.sweep == Sweep::sequential ? kernels_sequential() : pick_kernels(settings.isa);
}

/// Largest factor of substeps in a frame with fast colliders, unless Settings::most_substeps permits more.
constexpr int default_division = 8;

}  // namespace

World::Implementation::Implementation(const Scene& scene, const Settings& with, Scene* given_away)
    : settings(with), suggested(suggest(scene, with)), executor(with.threads), kernels(kernels_for(with)) {
  model.gravity = scene.gravity;
  model.wind = scene.wind;
  model.forces = scene.forces;
  model.pairs = scene.pairs;
  model.colliders = scene.colliders;
  for (int c = 0; c < static_cast<int>(scene.colliders.size()); ++c) collider_ids.add(c);
  std::vector<Sweep> sweeps;  // they depend on all objects
  for (int o = 0; o < static_cast<int>(scene.objects.size()); ++o) sweeps.push_back(chosen_sweep(scene, with, o));
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const CompileOptions options = compile_options(sweeps[o]);
    object_ids.add(model.add(given_away != nullptr ? compile(std::exchange(given_away->objects[o], {}), options)
                                                   : compile(scene.objects[o], options)));
  }
  for (const MeshCollider& collider : scene.mesh_colliders)
    mesh_collider_ids.add(add_to_model(collider, compile(collider)));
  state = initial_state(model);
  for (int number = 0; number < static_cast<int>(model.objects.size()); ++number) prepare(number);
  prepare_pairs();
  bring_up_to_date();
}

int World::Implementation::substeps_for(double dt, std::vector<std::string>& warnings) const {
  if (pair_model == nullptr) return settings.substeps;
  const double shortest = dt / shortest_substep;
  const int wanted = settings.most_substeps > 0 ? settings.most_substeps : default_division * settings.substeps;
  const int most = shortest < wanted ? static_cast<int>(shortest) : wanted;
  return divided_substeps(model, workspace.control, *pair_model, state, {state.time, dt, settings.substeps, most},
                          warnings);
}

World::World(const Scene& scene) {
  refuse_grave(scene);
  self_ = std::make_unique<Implementation>(scene, chosen_settings(scene));
}

World::World(const Scene& scene, const Settings& settings) {
  const auto checked_settings = [&] {
    Scene checked = scene;  // freed before compilation starts
    checked.settings = settings;
    refuse_grave(checked);
    return chosen_settings(checked);
  };
  self_ = std::make_unique<Implementation>(scene, checked_settings());
}

World::World(Scene&& scene) {
  refuse_grave(scene);
  self_ = std::make_unique<Implementation>(scene, chosen_settings(scene), &scene);
}

World::World(Scene&& scene, const Settings& settings) {
  scene.settings = settings;
  refuse_grave(scene);
  self_ = std::make_unique<Implementation>(scene, chosen_settings(scene), &scene);
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Report World::step(float dt) {
  Report report;
  report.frame = self_->state.frame;
  report.time = self_->state.time;
  if (!(dt > 0) || !std::isfinite(dt) || double(dt) / self_->settings.substeps < shortest_substep) {
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
  self_->bring_up_to_date();
  self_->begin_control(dt);
  report.substeps = self_->substeps_for(dt, report.warnings);
  self_->last_h = static_cast<float>(double(dt) / report.substeps);
  self_->stopped = true;  // stays set unless the step completes: a user's force field may throw
  pliant::step({self_->model, self_->state, self_->workspace, self_->executor, self_->kernels, report.substeps,
                self_->settings.iterations, self_->settings.sweep_options, self_->settings.record_residuals, self_->stop,
                self_->settings.separate_phases, static_cast<double>(self_->settings.tolerance)},
               dt, report);
  self_->stopped = report.nonfinite.has_value();
  self_->end_control(report.stopped);
  if (self_->workspace.contact_log != nullptr) self_->make_events();
  if (self_->settings.measure) {
    report.residuals = residuals();
    self_->measure(self_->lengths);
    report.stretch = self_->lengths.stretch;
    report.overstretch = self_->lengths.overstretch;
  }
  return report;
}

void World::stop_when(const std::atomic<bool>* flag) { self_->stop = flag; }

const State& World::state() const { return self_->state; }

const Settings& World::settings() const { return self_->settings; }
std::string World::isa() const { return self_->kernels.isa; }
int World::threads() const { return self_->executor.threads(); }

}  // namespace pliant
