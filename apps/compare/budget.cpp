// As many substeps as fit into some milliseconds a frame, for several numbers of iterations.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "apps/compare/compare.h"
#include "pliant/error.h"

namespace pliant::compare {

namespace {

constexpr int iterations_tried[] = {1, 2, 4, 10, 30};
constexpr int probe_frames = 6;      // from which the first guess is made
constexpr int probe_substeps = 2;    // of the probe
constexpr int most_substeps = 2000;  // more help nobody
constexpr int most_corrections = 3;  // of a guess that turns out too slow

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

/// The first `frames` frames of the scene; no value where they do not stay finite.
std::optional<Budgeted> simulate(const Scene& scene, const Method& method, int substeps, int iterations, int frames,
                                 const Options& options) {
  World world(scene, settings_of(scene, method, substeps, iterations));
  Budgeted found{method.name, substeps, iterations, 0, {0, 0, 0}, {}};
  std::vector<double> milliseconds;
  for (int frame = 0; frame < frames; ++frame) {
    if (options.pause) options.pause();
    const Report report = world.step(scene.frame_time);
    if (!report.ok()) return std::nullopt;
    milliseconds.push_back(report.milliseconds);
    take_larger(found.worst, *report.stretch);
    found.last = *report.stretch;
  }
  const auto middle = milliseconds.begin() + static_cast<std::ptrdiff_t>(milliseconds.size() / 2);
  std::nth_element(milliseconds.begin(), middle, milliseconds.end());
  found.milliseconds = *middle;
  return found;
}

/// As many substeps of `iterations` as fit.
std::optional<Budgeted> fit(const Scene& scene, const Method& method, int iterations, const Options& options) {
  const auto probe = simulate(scene, method, probe_substeps, iterations, std::min(probe_frames, scene.frames), options);
  if (!probe) return std::nullopt;
  int substeps = static_cast<int>(std::min(options.budget / probe->milliseconds * probe_substeps, 1. * most_substeps));
  for (int i = 0; i <= most_corrections && substeps >= 1; ++i) {
    auto found = simulate(scene, method, substeps, iterations, scene.frames, options);
    if (!found) return std::nullopt;
    if (found->milliseconds <= options.budget) return found;
    const double share = options.budget / found->milliseconds;
    substeps = std::min(substeps - 1, static_cast<int>(std::floor(0.98 * share * substeps)));
  }
  return std::nullopt;
}

}  // namespace

Budgeted fit_budget(const Scene& scene, const Method& method, const Options& options) {
  std::optional<Budgeted> best;
  for (int iterations : iterations_tried) {
    const auto found = fit(scene, method, iterations, options);
    if (found && (!best || found->worst.p99 < best->worst.p99)) best = found;
  }
  if (best) return *best;
  char words[96];
  std::snprintf(words, sizeof words, "no substep of one iteration fits into %.4g ms a frame and stays finite",
                options.budget);
  throw Error({}, words, "give more milliseconds");
}

}  // namespace pliant::compare
