// Measures curves: solves one substep from one State with more and more iterations.
//
// The speed of a shared machine varies. So the runs of a curve are timed in rounds, and so are the curves (run.cpp): a
// slow moment affects all or none. The least time is kept. A run contains all shorter ones, so its time is an upper
// bound of theirs.
//
// With contact between surfaces, a restored World searches initial intersections and rebuilds its near lists, which
// takes far longer than a sweep. In an ordinary run this is rare. So in this case the time is that of the next substep,
// while the residual is that of the first.
#include <algorithm>
#include <limits>
#include <utility>

#include "apps/compare/compare.h"
#include "pliant/error.h"

namespace pliant::compare {

namespace {

constexpr int repeats = 3;  // repetitions of a run in a round, because the first has cold caches
constexpr int most_rounds = 20;
constexpr double enough_milliseconds = 10;  // time to spend on all rounds of a run [ms]

/// The numbers 1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100 and so on up to `last`, and `last`.
std::vector<int> sampled_iterations(int last) {
  std::vector<int> numbers;
  for (int decade = 1; decade <= last; decade *= 10)
    for (int tenths : {10, 15, 20, 30, 50, 70})
      if (decade * tenths % 10 == 0 && decade * tenths / 10 < last) numbers.push_back(decade * tenths / 10);
  numbers.push_back(last);
  return numbers;
}

/// The number of particles that mesh colliders have in a State.
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

std::vector<IterationResidual> record_of(const Scene& scene, World& start, const Method& method,
                                         const Options& options) {
  Settings settings = settings_of(scene, method, options.iterations);
  settings.record_residuals = true;
  World world(scene, settings);
  take_state(world, start, collider_particles(scene));
  return step_once(world, scene, options).convergence;
}

/// The runs with one number of iterations.
struct Run {
  World world;
  State start;
  Sample sample;
};

Run run_of(const Scene& scene, World& start, const Method& method, int iterations) {
  World world(scene, settings_of(scene, method, iterations));
  take_state(world, start, collider_particles(scene));
  State state = world.state();
  return {std::move(world), std::move(state), {iterations, std::numeric_limits<double>::infinity(), 0, {}}};
}

/// The time of this substep; or of the next one, if this one did work that is necessary only after a restore. If the
/// next one is not finite, because the sweep diverges, that of this one.
double milliseconds_of(const Report& report, Run& run, const Scene& scene, const Options& options) {
  if (report.pairs.rebuilds == 0) return report.milliseconds;
  run.sample.of_next = true;
  const Report next = run.world.step(static_cast<float>(substep_of(scene, options)));
  return next.ok() ? next.milliseconds : report.milliseconds;
}

/// Solves the substep once more. Returns the time spent [ms].
double solve_again(Run& run, const Scene& scene, const Options& options) {
  double spent = 0;
  for (int i = 0; i < repeats; ++i) {
    if (options.pause) options.pause();
    run.world.restore(run.start);
    const Report report = step_once(run.world, scene, options);
    run.sample.stretch = run.world.measure().stretch();
    const double milliseconds = milliseconds_of(report, run, scene, options);
    run.sample.milliseconds = std::min(run.sample.milliseconds, milliseconds);
    spent += run.sample.of_next ? report.milliseconds + milliseconds : milliseconds;
  }
  return spent;
}

void solve_by_turns(std::vector<Run>& runs, const Scene& scene, const Options& options) {
  const double enough = enough_milliseconds * static_cast<double>(runs.size());
  double spent = 0;
  for (int round = 0; round == 0 || (round < most_rounds && spent < enough); ++round)
    for (Run& run : runs) spent += solve_again(run, scene, options);
}

std::vector<Sample> samples_of(const Scene& scene, World& start, const Method& method, const Options& options) {
  std::vector<Run> runs;
  for (int iterations : sampled_iterations(options.iterations))
    runs.push_back(run_of(scene, start, method, iterations));
  solve_by_turns(runs, scene, options);
  std::vector<Sample> samples;
  samples.reserve(runs.size());
  for (const Run& run : runs) samples.push_back(run.sample);
  return samples;
}

/// The residual that is plotted: that of distances if there are any, because it is a length; otherwise that of the
/// first type.
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
  curve.samples = samples_of(scene, start, method, options);
  lower_to_longer_runs(curve.samples);
  for (Sample& sample : curve.samples)
    sample.residual = curve.residuals.at(static_cast<std::size_t>(sample.iterations));
  return curve;
}

void time_again(const Scene& scene, World& start, const Method& method, const Options& options, Curve& curve) {
  const std::vector<Sample> again = samples_of(scene, start, method, options);
  for (std::size_t i = 0; i < again.size(); ++i)
    curve.samples[i].milliseconds = std::min(curve.samples[i].milliseconds, again[i].milliseconds);
  lower_to_longer_runs(curve.samples);
}

void lower_to_longer_runs(std::vector<Sample>& samples) {
  double longer = std::numeric_limits<double>::infinity();
  for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample)
    longer = sample->milliseconds = std::min(sample->milliseconds, longer);
}

double milliseconds_at(const Curve& curve, int iterations) {
  const auto after = std::find_if(curve.samples.begin(), curve.samples.end(),
                                  [&](const Sample& sample) { return sample.iterations >= iterations; });
  if (after == curve.samples.end()) return curve.samples.back().milliseconds;
  if (after == curve.samples.begin()) return after->milliseconds;
  const auto before = after - 1;
  const double share = static_cast<double>(iterations - before->iterations) / (after->iterations - before->iterations);
  return before->milliseconds + share * (after->milliseconds - before->milliseconds);
}

}  // namespace pliant::compare
