// For several numbers of iterations, finds how many substeps fit into a time per frame.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "apps/compare/compare.h"
#include "pliant/error.h"

namespace pliant::compare {

namespace {

constexpr int iterations_tried[] = {1, 2, 4, 10, 30};
constexpr int probe_frames = 6;      // frames of a first run, which gives an estimate
constexpr int probe_substeps = 2;    // substeps of that first run
constexpr int most_substeps = 2000;  // limit of substeps; more do not help
constexpr int most_corrections = 3;  // largest number of corrections of the estimate
constexpr double well_used = 1.2;    // an estimate is accepted if the budget is at most this many times the time used

Settings settings_of(const Scene& scene, const Method& method, int substeps, int iterations) {
  Settings settings = scene.settings;
  settings.sweep = method.sweep;
  settings.sweep_options = method.options;
  settings.substeps = substeps;
  settings.iterations = iterations;
  settings.tolerance = 0;
  settings.measure = true;
  settings.record_residuals = settings.record_multipliers = false;
  return settings;
}

void take_larger(Stretch& worst, const Stretch& stretch) {
  worst.mean = std::max(worst.mean, stretch.mean);
  worst.p99 = std::max(worst.p99, stretch.p99);
  worst.largest = std::max(worst.largest, stretch.largest);
}

/// The result of a run with some substeps and iterations.
struct Trial {
  Budgeted row;
  bool finite = true;  ///< false: a value was not finite; `row` is of the frames before
};

/// Simulates the first `frames` frames, or until a value is not finite.
Trial simulate(const Scene& scene, const Settings& settings, const std::string& name, int frames,
               const Options& options) {
  World world(scene, settings);
  Trial trial{{name, settings.substeps, settings.iterations, 0, {0, 0, 0}, {}}};
  std::vector<double> milliseconds;
  double substeps = 0;
  for (int frame = 0; frame < frames && trial.finite; ++frame) {
    if (options.pause) options.pause();
    const Report report = world.step(scene.frame_time);
    milliseconds.push_back(report.milliseconds);
    substeps += report.substeps;
    trial.finite = report.ok();
    if (!trial.finite) break;
    take_larger(trial.row.worst, *report.stretch);
    trial.row.last = *report.stretch;
  }
  const auto middle = milliseconds.begin() + static_cast<std::ptrdiff_t>(milliseconds.size() / 2);
  std::nth_element(milliseconds.begin(), middle, milliseconds.end());
  trial.row.milliseconds = *middle;
  if (settings.substeps == 0)
    trial.row.substeps = static_cast<int>(std::lround(substeps / static_cast<double>(milliseconds.size())));
  return trial;
}

Trial simulate(const Scene& scene, const Method& method, int substeps, int iterations, int frames,
               const Options& options) {
  return simulate(scene, settings_of(scene, method, substeps, iterations), method.name, frames, options);
}

/// Why numbers of substeps and iterations were not accepted.
struct Misses {
  double fastest = std::numeric_limits<double>::infinity();  ///< least time per frame of those above the budget [ms]
  int not_finite = 0;  ///< number of those within the budget in which a value became infinite or NaN
};

/// The substeps to try next, if the budget is `share` times the time used. The search ends if they are no more than the
/// last.
int next_substeps(int substeps, double share) {
  const int scaled = static_cast<int>(std::min(0.98 * share * substeps, 1. * most_substeps));
  return share < 1 ? std::min(substeps - 1, scaled) : scaled;
}

/// Finds the substeps with `iterations` iterations that fit into the budget. The first run serves only to measure time,
/// so its values may become infinite. If much of the budget is unused, because that run happened to be slow, more
/// substeps are tried.
std::optional<Budgeted> fit(const Scene& scene, const Method& method, int iterations, const Options& options,
                            Misses& misses) {
  const int frames = std::min(probe_frames, scene.frames);
  double taken = simulate(scene, method, probe_substeps, iterations, frames, options).row.milliseconds;
  int substeps = static_cast<int>(std::min(options.budget / taken * probe_substeps, 1. * most_substeps));
  taken /= probe_substeps;
  std::optional<Budgeted> found;
  for (int i = 0; i <= most_corrections && substeps >= 1; ++i) {
    const Trial trial = simulate(scene, method, substeps, iterations, scene.frames, options);
    taken = trial.row.milliseconds;
    const double share = options.budget / taken;
    if (share < 1 && found) break;
    if (share >= 1 && !trial.finite) {
      ++misses.not_finite;
      return found;
    }
    if (share >= 1) found = trial.row;
    const int next = next_substeps(substeps, share);
    if (share >= 1 && (share < well_used || next <= substeps)) break;
    substeps = next;
  }
  if (!found) misses.fastest = std::min(misses.fastest, taken);
  return found;
}

[[noreturn]] void refuse(const Misses& misses, const Options& options) {
  const std::string budget = figure(options.budget, 4) + " ms a frame";
  if (misses.not_finite == 0) {
    throw Error({},
                "nothing fits into " + budget + ": the cheapest trial takes about " + figure(misses.fastest, 2) + " ms",
                "increase the budget");
  }
  throw Error({}, "every combination that fits into " + budget + " diverges",
              "increase the budget, so that more substeps fit");
}

}  // namespace

Budgeted run_default(const Scene& scene, const Options& options) {
  Settings settings = settings_of(scene, {"", Sweep::automatic, scene.settings.sweep_options}, 0, 1);
  Trial trial = simulate(scene, settings, default_name, scene.frames, options);
  if (!trial.finite) throw Error({}, "the default diverges", "see 'pliant check'");
  return trial.row;
}

Budgeted fit_budget(const Scene& scene, const Method& method, const Options& options) {
  std::optional<Budgeted> best;
  Misses misses;
  for (int iterations : iterations_tried) {
    const auto found = fit(scene, method, iterations, options, misses);
    if (found && (!best || found->worst.p99 < best->worst.p99)) best = found;
  }
  if (!best) refuse(misses, options);
  return *best;
}

}  // namespace pliant::compare
