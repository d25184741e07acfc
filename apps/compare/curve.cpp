// One substep from one state, with more and more iterations.
#include <algorithm>
#include <limits>

#include "apps/compare/compare.h"
#include "pliant/error.h"

namespace pliant::compare {

namespace {

constexpr int fewest_repeats = 3, most_repeats = 200;
constexpr double enough_milliseconds = 30;  // of repeats

/// 1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100 and so on, and the last.
std::vector<int> sampled_iterations(int last) {
  std::vector<int> numbers;
  for (int decade = 1; decade <= last; decade *= 10)
    for (int tenths : {10, 15, 20, 30, 50, 70})
      if (decade * tenths % 10 == 0 && decade * tenths / 10 < last) numbers.push_back(decade * tenths / 10);
  numbers.push_back(last);
  return numbers;
}

/// Particles that mesh colliders have in a State.
std::size_t collider_particles(const Scene& scene) {
  std::size_t count = 0;
  for (const MeshCollider& collider : scene.mesh_colliders) count += collider.mesh.positions.size();
  return count;
}

Settings settings_of(const Scene& scene, const Method& method, int iterations) {
  Settings settings = scene.settings;
  settings.sweep = method.sweep;
  settings.sweep_options = method.options;
  settings.substeps = 1;
  settings.iterations = iterations;
  settings.tolerance = 0;
  settings.measure = settings.record_residuals = settings.record_multipliers = false;
  return settings;
}

Report step_once(World& world, const Scene& scene, const Options& options) {
  Report report = world.step(static_cast<float>(substep_of(scene, options)));
  if (!report.ok()) throw Error({}, report.explain());
  return report;
}

std::vector<IterationResidual> record_of(const Scene& scene, World& start, const Method& method, const Options& options) {
  Settings settings = settings_of(scene, method, options.iterations);
  settings.record_residuals = true;
  World world(scene, settings);
  take_state(world, start, collider_particles(scene));
  return step_once(world, scene, options).convergence;
}

Sample sample_at(const Scene& scene, World& start, const Method& method, int iterations, const Options& options) {
  World world(scene, settings_of(scene, method, iterations));
  take_state(world, start, collider_particles(scene));
  const State state = world.state();
  Sample sample{iterations, std::numeric_limits<double>::infinity(), 0, {}};
  double spent = 0;
  for (int i = 0; i < fewest_repeats || (i < most_repeats && spent < enough_milliseconds); ++i) {
    world.restore(state);
    const double milliseconds = step_once(world, scene, options).milliseconds;
    sample.milliseconds = std::min(sample.milliseconds, milliseconds);
    spent += milliseconds;
  }
  sample.stretch = world.stretch();
  return sample;
}

/// Of distances where there are any, since it is a length; else of the first type there is.
double drawn_residual(const IterationResidual& at) {
  for (const Residual& residual : at.primal)
    if (residual.type == "distance") return residual.rms;
  return at.primal.empty() ? 0 : at.primal.front().rms;
}

}  // namespace

double substep_of(const Scene& scene, const Options& options) {
  const int substeps = options.substeps > 0 ? options.substeps : scene.settings.substeps;
  return static_cast<double>(scene.frame_time) / substeps;
}

Curve measure_curve(const Scene& scene, World& start, const Method& method, const Options& options) {
  Curve curve;
  curve.name = method.name;
  curve.record = record_of(scene, start, method, options);
  for (const IterationResidual& at : curve.record) curve.residuals.push_back(drawn_residual(at));
  for (int iterations : sampled_iterations(options.iterations)) {
    if (options.pause) options.pause();
    curve.samples.push_back(sample_at(scene, start, method, iterations, options));
    curve.samples.back().residual = curve.residuals.at(static_cast<std::size_t>(iterations));
  }
  return curve;
}

}  // namespace pliant::compare
