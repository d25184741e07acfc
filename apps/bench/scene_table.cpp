#include "apps/bench/scene_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "apps/bench/bending_energy.h"
#include "pliant/error.h"
#include "pliant/queries.h"
#include "pliant/world.h"

namespace pliant::bench {

namespace {

constexpr std::size_t frames_at_rest = 30;  ///< over which SceneRow::moved is the mean

double mass_of(const Scene& scene) {
  double mass = 0;
  for (const Object& object : scene.objects)
    for (const float m : object.masses) mass += std::isfinite(m) ? static_cast<double>(m) : 0;
  return mass;
}

/// The mean distance between the particles of two moments.
double mean_motion(const World& world, const std::vector<std::vector<Vec3f>>& before) {
  double sum = 0;
  std::size_t count = 0, o = 0;
  for (const ObjectId id : world.objects()) {
    const std::vector<Vec3f> now = world.object(id).positions();
    for (std::size_t i = 0; i < now.size(); ++i) sum += std::sqrt(double(length_squared(now[i] - before[o][i])));
    count += now.size();
    ++o;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

std::vector<std::vector<Vec3f>> positions_of(const World& world) {
  std::vector<std::vector<Vec3f>> all;
  for (const ObjectId id : world.objects()) all.push_back(world.object(id).positions());
  return all;
}

/// Leaves sweep, substeps, their bounds and iterations open.
void leave_open(Scene& scene) {
  scene.settings.sweep = Sweep::automatic;
  scene.settings.sweep_options = {};
  scene.settings.substeps = scene.settings.least_substeps = scene.settings.most_substeps = 0;
  scene.settings.iterations = 1;
  for (Object& object : scene.objects) object.sweep = Sweep::automatic;
}

/// "chains+tethers 40" as a sweep with tethers and 40 substeps; without a number the substeps that the scene chooses
/// for it.
void apply(const std::string& text, Scene& scene) {
  if (text == "own") return;
  leave_open(scene);
  if (text == "default") return;
  Settings& settings = scene.settings;
  const std::size_t space = text.find(' ');
  const std::string method = text.substr(0, space), name = method.substr(0, method.find('+'));
  const auto known =
      std::find_if(sweeps().begin(), sweeps().end(), [&](const NamedSweep& s) { return s.name == name; });
  const int substeps = space == std::string::npos ? 0 : std::atoi(text.c_str() + space);
  if (known == sweeps().end() || (space != std::string::npos && substeps < 1))
    throw Error({}, "'" + text + "' names no sweep and substeps", "write for example 'chains 40'");
  settings.sweep = known->sweep;
  settings.sweep_options.tethers = method == name + "+tethers";
  settings.substeps = substeps;
}

/// The triangles of all objects and mesh colliders of a scene, objects first.
class Surfaces {
 public:
  explicit Surfaces(const Scene& scene) : colliders_(scene.mesh_colliders.size()) {
    for (const Object& object : scene.objects) add(object.triangles, object.positions.size());
    dynamic_ = count_;
    for (const MeshCollider& collider : scene.mesh_colliders)
      add(collider.mesh.triangles, collider.mesh.positions.size());
    finder_.emplace(triangles_, count_);
  }

  /// The number of edges that pass through a triangle. Colliders may intersect themselves and one another.
  int crossings(const World& world) {
    std::vector<Vec3f> all;
    const auto append = [&](const std::vector<Vec3f>& more) { all.insert(all.end(), more.begin(), more.end()); };
    for (const ObjectId id : world.objects()) append(world.object(id).positions());
    for (std::size_t c = 0; c < colliders_; ++c) append(world.mesh_collider(static_cast<int>(c)).positions());
    const std::vector<Crossing>& found = finder_->find(all);
    const auto is_dynamic = [&](const Crossing& crossing) {
      return crossing.a < dynamic_ || triangles_[static_cast<std::size_t>(crossing.triangle)][0] < dynamic_;
    };
    return static_cast<int>(std::count_if(found.begin(), found.end(), is_dynamic));
  }

 private:
  void add(const std::vector<std::array<int, 3>>& triangles, std::size_t vertices) {
    for (const auto& [a, b, c] : triangles) triangles_.push_back({count_ + a, count_ + b, count_ + c});
    count_ += static_cast<int>(vertices);
  }

  std::size_t colliders_;
  std::vector<std::array<int, 3>> triangles_;
  int count_ = 0, dynamic_ = 0;  ///< vertices of all surfaces, of objects
  std::optional<CrossingFinder> finder_;
};

void set_overstretch(const WorstOverstretch& worst, SceneRow& row) {
  row.p99 = worst.overstretch.p99;
  row.largest = worst.overstretch.largest;
  row.frame_of_p99 = static_cast<int>(worst.frame_of_p99);
  row.frame_of_largest = static_cast<int>(worst.frame_of_largest);
}

SceneRow measure(const NamedScene& named, const std::string& settings, const SceneTableOptions& options) {
  Scene scene = named.scene;
  apply(settings, scene);
  scene.settings.threads = options.threads;
  World world(scene);
  std::optional<Surfaces> surfaces;
  if (options.counts_crossings) surfaces.emplace(scene);
  SceneRow row{named.name, settings};
  row.frames = options.frames > 0 ? options.frames : scene.frames;
  for (const ObjectId id : world.objects()) row.particles += world.object(id).info().particles;
  const double mass = std::max(mass_of(scene), 1e-30);
  double least = world.measure().kinetic_energy() + world.measure().potential_energy();
  const BendingEnergy folds(scene);
  double least_with_bending = least + folds.of(world);
  std::vector<double> motions;
  for (int frame = 1; frame <= row.frames; ++frame) {
    const auto before = positions_of(world);
    const Report report = world.step(scene.frame_time);
    row.finite = report.ok();
    if (!row.finite) break;
    set_overstretch(report.worst_overstretch, row);
    if (surfaces) row.crossings = std::max(row.crossings, surfaces->crossings(world));
    const double energy = world.measure().kinetic_energy() + world.measure().potential_energy();
    least = std::min(least, energy);
    row.gain = std::max(row.gain, (energy - least) / mass);
    const double with_bending = energy + folds.of(world);
    least_with_bending = std::min(least_with_bending, with_bending);
    row.gain_with_bending = std::max(row.gain_with_bending, (with_bending - least_with_bending) / mass);
    row.milliseconds += report.milliseconds / row.frames;
    row.substeps += double(report.substeps) / row.frames;
    motions.push_back(mean_motion(world, before));
  }
  const std::size_t last = std::min(frames_at_rest, motions.size());
  if (named.yield) row.yield = named.yield(world);
  if (last > 0)
    row.moved = std::accumulate(motions.end() - static_cast<std::ptrdiff_t>(last), motions.end(), 0.0) / double(last);
  return row;
}

}  // namespace

bool holds(const SceneRow& row) {
  const bool is_within = row.p99 <= tolerated_p99 && row.largest <= tolerated_overstretch;
  return row.finite && is_within && row.crossings <= 0;
}

void refuse_unknown_settings(const std::vector<std::string>& settings) {
  Scene scene;
  for (const std::string& one : settings) apply(one, scene);
}

void compare_costs(std::vector<SceneRow>& rows) {
  const SceneRow* best = nullptr;
  for (const SceneRow& row : rows)
    if (row.settings != "default" && row.settings != "own" && holds(row) &&
        (best == nullptr || row.milliseconds < best->milliseconds))
      best = &row;
  if (best == nullptr) return;
  rows.front().cheapest = best->settings;
  rows.front().ratio = rows.front().milliseconds / best->milliseconds;
}

std::vector<SceneRow> measure_scenes(const std::vector<NamedScene>& scenes, const SceneTableOptions& options) {
  std::vector<std::string> settings{"default"};
  settings.insert(settings.end(), options.against.begin(), options.against.end());
  std::vector<SceneRow> rows;
  for (const NamedScene& scene : scenes) {
    std::vector<SceneRow> of_scene;
    for (const std::string& one : settings) of_scene.push_back(measure(scene, one, options));
    compare_costs(of_scene);
    for (const SceneRow& row : of_scene)
      if (options.on_row) options.on_row(row);
    rows.insert(rows.end(), of_scene.begin(), of_scene.end());
  }
  return rows;
}

}  // namespace pliant::bench
