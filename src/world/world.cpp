// A World: a Scene compiled, a State owned, and the step that joins them.
#include "pliant/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "collision/fields/solid_fields.h"
#include "constraints/registry.h"
#include "core/sha256.h"
#include "inspect/inspect_scene.h"
#include "math/quat.h"
#include "matter/advice_settings.h"
#include "model/model.h"
#include "parallel/executor.h"
#include "pliant/error.h"
#include "solver/divide.h"
#include "solver/kernels.h"
#include "solver/measure.h"
#include "solver/step.h"
#include "solver/sweeps/sweep.h"
#include "world/advice.h"

namespace pliant {

namespace {

const Kernels& kernels_for(const Settings& settings) {
  return settings.sweep == Sweep::sequential ? kernels_sequential() : pick_kernels(settings.isa);
}

/// Those that are asked for; else those that a second pass needs or that say how much of a length is meant.
Multipliers kept_multipliers(const Settings& settings, Sweep sweep) {
  if (settings.record_multipliers || settings.record_residuals) return Multipliers::all;
  const bool more_passes = settings.iterations * sweep_method(sweep).passes > 1;
  return more_passes || settings.measure ? Multipliers::needed : Multipliers::none;
}

/// A frame takes at most so many times as long for what moves fast, unless Settings::most_substeps allows more.
constexpr int default_division = 8;

/// So many frames no run takes; counting on from there stays far from the end of the integers.
constexpr std::int64_t largest_frame = std::int64_t{1} << 60;

/// They belong to the last substep, and a restored state has none: what is read then is the same in any World.
void forget_multipliers(Workspace& workspace) {
  for (auto& object : workspace.multipliers)
    for (auto& values : object) std::fill(values.begin(), values.end(), 0.f);
  std::fill(workspace.volume_multipliers.begin(), workspace.volume_multipliers.end(), 0.);
}

void add_records(Sha256& sha, const Records& records) { sha.add(records.data(), records.size() * sizeof(Record)); }

}  // namespace

struct World::Implementation {
  Implementation(const Scene& scene, const Settings& with)
      : settings(with), suggested(suggest(scene, with)), executor(with.threads), kernels(kernels_for(with)) {
    model.gravity = scene.gravity;
    model.wind = scene.wind;
    model.forces = scene.forces;
    model.colliders = scene.colliders;
    model.pairs = scene.pairs;
    for (int o = 0; o < static_cast<int>(scene.objects.size()); ++o) {
      CompileOptions options;
      options.sweep = chosen_sweep(scene, with, o);
      options.passes = settings.substeps * settings.iterations * sweep_method(options.sweep).passes;
      options.chain_softness = settings.sweep_options.chain_softness;
      options.tethers = settings.sweep_options.tethers;
      options.tether_slack = settings.sweep_options.tether_slack;
      options.air = scene.wind.air_density > 0;
      options.gravity = length(model.gravity);
      model.add(compile(scene.objects[static_cast<std::size_t>(o)], options));
    }
    model.user_objects = static_cast<int>(model.objects.size());
    for (const MeshCollider& collider : scene.mesh_colliders) add(collider);
    if (model.first.empty()) model.first.push_back(0);
    state = initial_state(model);
    pair_model = make_pair_model(model, state.positions);
    if (pair_model != nullptr) {
      pair_model->filter = settings.contact_filter;
      if (settings.initial_intersections == Settings::Intersections::untangle)
        pair_model->untangling_speed = settings.untangling_speed;
      workspace.pairs = std::make_unique<SurfaceContact>(*pair_model, kernels.pairs);
    }
    for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) prepare(o);
    if (settings.tolerance > 0) prepare_residual(model, workspace.residual);
  }

  void prepare(int object) {
    pliant::prepare(model, object, kept_multipliers(settings, model.objects[object].sweep), workspace);
    prepare_sweep(model, object, settings, executor.threads(), workspace);
  }

  void add(const MeshCollider& collider) {
    model.add(compile(collider));
    if (collider.as == MeshCollider::As::triangles) return;
    model.fields.push_back({solid_field_of(collider), collider.motion, collider.thickness, collider.static_friction,
                            collider.kinetic_friction, collider.restitution, collider.groups, collider.mask});
  }

  const CompiledObject& object(int index) const {
    if (index < 0 || index >= model.user_objects) {
      throw Error({}, "there is no object " + std::to_string(index), "object_count() says how many there are");
    }
    return model.objects[index];
  }

  const Record* positions_of(int index) const {
    (void)object(index);  // throws where there is none
    return state.positions.data() + model.first[index];
  }

  std::vector<Vec3f> in_user_order(int index, const Records& records) const {
    (void)object(index);  // throws where there is none
    return in_given_order(index, records);
  }

  /// Of objects and mesh colliders alike, which follow them.
  std::vector<Vec3f> in_given_order(int index, const Records& records) const {
    const CompiledObject& from = model.objects[index];
    std::vector<Vec3f> out(from.user_particles);
    for (int user = 0; user < from.user_particles; ++user) {
      const Record& r = records[static_cast<std::size_t>(model.first[index]) + from.place[user]];
      out[user] = {r.x, r.y, r.z};
    }
    return out;
  }

  /// Into how many substeps the next frame is divided.
  int substeps_for(double dt, std::vector<std::string>& warnings) const {
    if (pair_model == nullptr) return settings.substeps;
    const double shortest = dt / shortest_substep;
    const int wanted = settings.most_substeps > 0 ? settings.most_substeps : default_division * settings.substeps;
    const int most = shortest < wanted ? static_cast<int>(shortest) : wanted;
    return divided_substeps(model, *pair_model, state, {state.time, dt, settings.substeps, most}, warnings);
  }

  Lengths measured_lengths() const {
    Lengths measured;
    measure_lengths(model, state, workspace, last_h, measured);
    return measured;
  }

  Posef collider_pose_now(int index) const {
    if (index < 0 || index >= static_cast<int>(model.colliders.size())) {
      throw Error({}, "there is no collider " + std::to_string(index), "use an index that Scene::add returned");
    }
    return convert<float>(collider_pose(model.colliders[index], state.time));
  }

  Settings settings, suggested;  ///< as they are, and as measured best on scenes of this kind
  Executor executor;
  const Kernels& kernels;
  Model model;
  std::unique_ptr<PairModel> pair_model;
  State state;
  Workspace workspace;
  Lengths lengths;
  float last_h = 1;
  bool stopped = false;
  const std::atomic<bool>* stop = nullptr;  ///< of stop_when
};

World::World(const Scene& scene) {
  refuse_grave(scene);
  self_ = std::make_unique<Implementation>(scene, chosen_settings(scene));
}

World::World(const Scene& scene, const Settings& settings) {
  const auto checked_settings = [&] {
    Scene checked = scene;  // gone again before anything is compiled
    checked.settings = settings;
    refuse_grave(checked);
    return chosen_settings(checked);
  };
  self_ = std::make_unique<Implementation>(scene, checked_settings());
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
  report.substeps = self_->substeps_for(dt, report.warnings);
  self_->last_h = static_cast<float>(double(dt) / report.substeps);
  self_->stopped = true;  // unless the step comes to its end: a force field of the user's own may throw
  pliant::step({self_->model, self_->state, self_->workspace, self_->executor, self_->kernels, report.substeps,
                self_->settings.iterations, self_->settings.sweep_options, self_->settings.record_residuals, self_->stop,
                self_->settings.separate_phases, static_cast<double>(self_->settings.tolerance)},
               dt, report);
  self_->stopped = report.nonfinite.has_value();
  if (self_->settings.measure) {
    report.residuals = residuals();
    Lengths& lengths = self_->lengths;
    measure_lengths(self_->model, self_->state, self_->workspace, self_->last_h, lengths);
    report.stretch = lengths.stretch;
    report.overstretch = lengths.overstretch;
  }
  return report;
}

void World::stop_when(const std::atomic<bool>* flag) { self_->stop = flag; }

const State& World::state() const { return self_->state; }

namespace {

/// Throws unless `given` are the frames of a state of this world.
void require_frames_of(const FrameRecords& own, const FrameRecords& given) {
  const std::size_t frames = own.size();
  if (given.orientations.size() != frames || given.angular_velocities.size() != frames ||
      given.inverse_inertias.size() != frames)
    throw Error({}, "the state has " + std::to_string(given.size()) + " frames, the world " + std::to_string(frames),
                "restore a state of this world");
  for (std::size_t i = 0; i < frames; ++i) {
    const Record &q = given.orientations[i], &w = given.angular_velocities[i];
    const Record &inertia = given.inverse_inertias[i], &same = own.inverse_inertias[i];
    const std::string element = "frame " + std::to_string(i);
    if (inertia.x != same.x || inertia.y != same.y || inertia.z != same.z)
      throw Error({.element = element}, "its inertia is not this world's", "restore a state of this world");
    if (!std::isfinite(q.x + q.y + q.z + q.w) || !std::isfinite(w.x + w.y + w.z))
      throw Error({.element = element}, "its orientation or angular velocity is not finite", "restore an earlier state");
  }
}

}  // namespace

void World::restore(const State& state) {
  const std::size_t particles = self_->state.positions.size();
  if (state.positions.size() != particles || state.velocities.size() != particles || state.remainders.size() != particles) {
    throw Error(
        {},
        "the state has " + std::to_string(state.positions.size()) + " particles, the world " + std::to_string(particles),
        "restore a state of this world");
  }
  const auto is_finite = [](const Record& r) { return std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z); };
  for (std::size_t i = 0; i < particles; ++i) {
    if (state.positions[i].w != self_->state.positions[i].w) {
      throw Error({.element = "particle " + std::to_string(i)}, "its mass is not this world's",
                  "restore a state of this world");
    }
    if (state.velocities[i].w != 0 || state.remainders[i].w != 0) {
      throw Error({.element = "particle " + std::to_string(i)}, "the fourth number of its velocity or remainder is not 0",
                  "restore a state of this world");
    }
    if (!is_finite(state.positions[i]) || !is_finite(state.velocities[i]) || !is_finite(state.remainders[i])) {
      throw Error({.element = "particle " + std::to_string(i)}, "its position or velocity is not finite",
                  "restore an earlier state");
    }
  }
  require_frames_of(self_->state.frames, state.frames);
  if (!std::isfinite(state.time)) throw Error({}, "the state's time is not finite", "restore an earlier state");
  if (state.frame < 0 || state.frame > largest_frame)
    throw Error({}, "the state's frame is " + std::to_string(state.frame), "restore a state of this world");
  self_->state = state;
  forget_multipliers(self_->workspace);
  self_->workspace.look_for_tangles = true;
  self_->stopped = false;
}

int World::object_count() const { return self_->model.user_objects; }

ObjectInfo World::info(int object) const {
  const CompiledObject& from = self_->object(object);
  ObjectInfo info{from.name, from.user_particles, {}};
  for (int type = 0; type < constraint_type_count(); ++type) {
    std::int64_t count = 0;
    for (const Pool& pool : from.pools) count += pool.type == type ? pool.constraints : 0;
    if (count > 0) info.constraints.emplace_back(constraint_type(type).name, count);
  }
  if (from.has_volume) info.constraints.emplace_back("volume", 1);
  return info;
}

const Settings& World::settings() const { return self_->settings; }
std::string World::isa() const { return self_->kernels.isa; }
int World::threads() const { return self_->executor.threads(); }

std::vector<Vec3f> World::positions(int object) const { return self_->in_user_order(object, self_->state.positions); }
std::vector<Vec3f> World::velocities(int object) const { return self_->in_user_order(object, self_->state.velocities); }

std::vector<Quatf> World::orientations(int object) const {
  std::vector<Quatf> out;
  for (std::size_t i = 0; i < self_->object(object).frames.size(); ++i) {
    const Record& q = self_->state.frames.orientations[self_->model.first_frame[object] + i];
    out.push_back({q.x, q.y, q.z, q.w});
  }
  return out;
}

std::vector<Vec3f> World::angular_velocities(int object) const {
  std::vector<Vec3f> out;
  const std::vector<Quatf> rotation = orientations(object);
  for (std::size_t i = 0; i < rotation.size(); ++i) {
    const Record& w = self_->state.frames.angular_velocities[self_->model.first_frame[object] + i];
    out.push_back(rotate(rotation[i], Vec3f{w.x, w.y, w.z}));
  }
  return out;
}

TriangleMesh World::mesh(int object) const {
  TriangleMesh mesh{positions(object), {}};
  const CompiledObject& from = self_->object(object);
  for (const auto& t : from.surface.triangles)
    mesh.triangles.push_back({from.order[t[0]], from.order[t[1]], from.order[t[2]]});
  return mesh;
}

Vec3f World::collider_position(int collider) const { return self_->collider_pose_now(collider).position; }
Quatf World::collider_rotation(int collider) const { return self_->collider_pose_now(collider).rotation; }

std::vector<Vec3f> World::mesh_collider_positions(int collider) const {
  const int first = self_->model.user_objects, last = static_cast<int>(self_->model.objects.size());
  if (collider < 0 || collider >= last - first) {
    throw Error({}, "there is no mesh collider " + std::to_string(collider), "use an index that Scene::add returned");
  }
  return self_->in_given_order(first + collider, self_->state.positions);
}

std::vector<float> World::multipliers(int object, const std::string& type) const {
  const CompiledObject& from = self_->object(object);
  std::vector<float> out;
  if (type == "volume" && from.has_volume) return {static_cast<float>(self_->workspace.volume_multipliers[object])};
  if (self_->workspace.multipliers[object].empty()) return out;
  for (std::size_t p = 0; p < from.pools.size(); ++p) {
    const Pool& pool = from.pools[p];
    if (type != constraint_types()[pool.type].name || self_->workspace.multipliers[object][p].empty()) continue;
    for (std::size_t lane = 0; lane < pool.origin.size(); ++lane) {
      if (pool.origin[lane] < 0) continue;
      const std::size_t first = static_cast<std::size_t>(pool.origin[lane]) * pool.components;
      if (out.size() < first + pool.components) out.resize(first + pool.components, 0.f);
      for (int row = 0; row < pool.components; ++row)
        out[first + row] = self_->workspace.multipliers[object][p][multiplier_index(
            pool, static_cast<std::int64_t>(lane) / batch_width, static_cast<int>(lane % batch_width), row)];
    }
  }
  return out;
}

double World::kinetic_energy() const {
  double energy = 0;
  for (std::size_t i = 0; i < self_->state.positions.size(); ++i) {
    const Record &v = self_->state.velocities[i], &x = self_->state.positions[i];
    if (x.w > 0) energy += 0.5 / x.w * (double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z);
  }
  const FrameRecords& frames = self_->state.frames;
  const auto turning = [](float speed, float inverse) { return inverse > 0 ? 0.5 / inverse * speed * speed : 0.0; };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Record &w = frames.angular_velocities[i], &inverse = frames.inverse_inertias[i];
    energy += turning(w.x, inverse.x) + turning(w.y, inverse.y) + turning(w.z, inverse.z);
  }
  return energy;
}

double World::potential_energy() const {
  double energy = 0;
  const Vec3f& g = self_->model.gravity;
  for (const Record& x : self_->state.positions) {
    if (x.w > 0) energy -= 1.0 / x.w * (double(g.x) * x.x + double(g.y) * x.y + double(g.z) * x.z);
  }
  return energy;
}

std::vector<Residual> World::residuals() const {
  return measure_residuals(self_->model, self_->state, self_->workspace, self_->last_h);
}
Stretch World::stretch() const { return self_->measured_lengths().stretch; }
Overstretch World::overstretch() const { return self_->measured_lengths().overstretch; }

std::string World::describe(const Overstretch& found) const {
  return found.object < 0 ? std::string() : words_of(found, self_->object(found.object));
}

std::string World::advice(const Report& report) const {
  if (!report.overstretch || !(report.overstretch->largest > tolerated_overstretch)) return {};
  const std::string sweep = in_json(self_->suggested, self_->settings);
  return describe(*report.overstretch) + "; more than " + std::to_string(self_->settings.substeps) + " substeps" +
         (sweep == "{}" ? "" : ", or \"settings\": " + sweep + " in the scene,") +
         " may bring that down: 'pliant check', or advise(), tries how many it takes";
}

double World::enclosed_volume(int object) const {
  return measure_volume(self_->object(object), self_->positions_of(object));
}

std::string hash(const State& state) {
  Sha256 sha;
  sha.add(&state.time, sizeof state.time);
  sha.add(&state.frame, sizeof state.frame);
  add_records(sha, state.positions);
  add_records(sha, state.remainders);
  add_records(sha, state.velocities);
  if (state.frames.size() > 0) {
    add_records(sha, state.frames.orientations);
    add_records(sha, state.frames.angular_velocities);
    add_records(sha, state.frames.inverse_inertias);
  }
  for (const Channel& channel : state.channels) {
    const std::uint64_t sizes[] = {channel.name.size(), static_cast<std::uint64_t>(channel.components),
                                   channel.values.size()};
    sha.add(sizes, sizeof sizes);
    sha.add(channel.name.data(), channel.name.size());
    sha.add(channel.values.data(), channel.values.size() * sizeof(float));
  }
  return sha.finish();
}

std::string Report::explain() const {
  std::string text;
  if (nonfinite && nonfinite->object.empty()) {
    text = "frame " + std::to_string(nonfinite->frame) + ": " + nonfinite->element + "; restore a state to go on";
  } else if (nonfinite) {
    text = "frame " + std::to_string(nonfinite->frame) + ", substep " + std::to_string(nonfinite->substep) + ": object '" +
           nonfinite->object + "', " + nonfinite->element +
           " is the first with a value that is not finite; more substeps, less stiffness or a smaller velocity may help";
  }
  for (const std::string& warning : warnings) text += (text.empty() ? "" : "\n") + warning;
  return text;
}

}  // namespace pliant
