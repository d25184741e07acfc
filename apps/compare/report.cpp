// Writes the results as a table and as JSON.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/compare/compare.h"

namespace pliant::compare {

namespace {

using Json = nlohmann::ordered_json;

constexpr double slow = 0.05;  ///< speed below which a scene counts as almost at rest [m/s]

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[320];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

// ------------------------------------------------------------------------------------------------ figures of a curve

/// The first iteration whose residual is at most a tenth of the prediction's; -1: none.
int iterations_to_a_tenth(const Curve& curve) {
  for (std::size_t i = 1; i < curve.residuals.size(); ++i)
    if (curve.residuals[i] <= 0.1 * curve.residuals.front()) return static_cast<int>(i);
  return -1;
}

double milliseconds_an_iteration(const Curve& curve) {
  const Sample &first = curve.samples.front(), &last = curve.samples.back();
  if (last.iterations == first.iterations) return last.milliseconds;
  return (last.milliseconds - first.milliseconds) / (last.iterations - first.iterations);
}

/// The samples that the table shows: the first, the one in the middle of a logarithmic axis, the last.
std::vector<std::size_t> shown_samples(const Curve& curve) {
  const std::size_t last = curve.samples.size() - 1;
  std::vector<std::size_t> shown{0};
  std::size_t middle = 0;
  while (middle < last && std::pow(curve.samples[middle].iterations, 2) < curve.samples[last].iterations) ++middle;
  if (middle > 0 && middle < last) shown.push_back(middle);
  if (last > 0) shown.push_back(last);
  return shown;
}

// ------------------------------------------------------------------------------------------------ the table

/// Cloth at rest has little to correct, so its curves say little about the sweeps.
std::string rest_note(const Result& result) {
  if (result.frame == 0 || result.speed >= slow) return {};
  return format("the scene is almost at rest there, at %s m/s in the mean: choose a --frame in motion\n",
                figure(result.speed, 2).c_str());
}

std::string table_head(const Result& result) {
  const Curve& first = result.curves.front();
  std::string head =
      format("after %d frames: the next substep, of %s ms, solved by each sweep from the same state\n", result.frame,
             figure(1000 * result.substep, 4).c_str()) +
      rest_note(result) + "default of the scene: " + result.by_default +
      (result.budget > 0 ? "" : "; its curve is that of its sweep, and --budget-ms runs it too") + "\n" +
      format("residual: root mean square error of the %s constraints%s, %.3g before the first iteration\n",
             result.residual_type.c_str(), result.residual_type == "distance" ? " [m]" : "", first.residuals.front()) +
      "stretch: largest elongation beyond rest length [%]\n" +
      (times_next(result) ? "ms: of the substep after it, since the first one after a restore rebuilds near lists\n"
                          : "") +
      "\n";
  std::string above = format("%-18s %9s ", "", "ms an"), below = format("%-18s %9s ", "sweep", "iteration");
  for (const char* what : {"residual", "stretch"}) {
    for (std::size_t i : shown_samples(first)) {
      above += format(" %9s", what);
      below += format(" %9s", ("after " + std::to_string(first.samples[i].iterations)).c_str());
    }
  }
  return head + above + "  iterations and ms\n" + below + "  to a tenth of the residual\n";
}

std::string curve_row(const Curve& curve) {
  std::string row = format("%-18s %9.4f ", curve.name.c_str(), milliseconds_an_iteration(curve));
  for (std::size_t i : shown_samples(curve)) row += format(" %9.2e", curve.samples[i].residual);
  for (std::size_t i : shown_samples(curve)) row += format(" %9.3g", percent(curve.samples[i].stretch.largest));
  const int tenth = iterations_to_a_tenth(curve);
  if (tenth < 0) return row + format("  %10s %9s\n", "-", "-");
  return row + format("  %10d %9.4f\n", tenth, milliseconds_at(curve, tenth));
}

std::string budget_table(const Result& result) {
  if (result.budgeted.empty()) return {};
  std::string table = format("\nwithin %s ms per frame, %d frames from the start; stretch: worst of all frames [%%]\n",
                             figure(result.budget, 4).c_str(), result.frames) +
                      format("%-18s %8s x %-10s %8s %9s %9s %9s\n", "sweep", "substeps", "iterations", "ms/frame",
                             "mean", "p99", "largest");
  for (const Budgeted& row : result.budgeted)
    table += format("%-18s %8d x %-10d %8.3f %9.3g %9.3g %9.3g\n", row.name.c_str(), row.substeps, row.iterations,
                    row.milliseconds, percent(row.worst.mean), percent(row.worst.p99), percent(row.worst.largest));
  return table;
}

// ------------------------------------------------------------------------------------------------ JSON

Json json_of(const Stretch& stretch) {
  return {{"mean", stretch.mean}, {"p99", stretch.p99}, {"largest", stretch.largest}};
}

Json json_of(const IterationResidual& at) {
  Json primal = Json::object();
  for (const Residual& residual : at.primal)
    primal[residual.type] = {{"rms", residual.rms}, {"largest", residual.largest}};
  return {
      {"iteration", at.iteration}, {"primal", primal}, {"dual_rms", at.dual_rms}, {"dual_largest", at.dual_largest}};
}

Json json_of(const Curve& curve) {
  Json json = {{"sweep", curve.name}, {"ms_per_iteration", milliseconds_an_iteration(curve)}};
  for (const Sample& sample : curve.samples)
    json["samples"].push_back({{"iterations", sample.iterations},
                               {"ms", sample.milliseconds},
                               {"residual", sample.residual},
                               {"stretch", json_of(sample.stretch)}});
  for (const IterationResidual& at : curve.record) json["residuals"].push_back(json_of(at));
  return json;
}

Json json_of(const Budgeted& row) {
  return {{"sweep", row.name},
          {"substeps", row.substeps},
          {"iterations", row.iterations},
          {"ms_per_frame", row.milliseconds},
          {"worst_stretch", json_of(row.worst)},
          {"last_stretch", json_of(row.last)}};
}

}  // namespace

bool times_next(const Result& result) {
  return std::any_of(result.curves.begin(), result.curves.end(), [](const Curve& curve) {
    return std::any_of(curve.samples.begin(), curve.samples.end(), [](const Sample& sample) { return sample.of_next; });
  });
}

std::string to_table(const Result& result) {
  std::string table = table_head(result);
  for (const Curve& curve : result.curves) table += curve_row(curve);
  return table + budget_table(result);
}

std::string to_json(const Result& result) {
  Json json = {{"frame", result.frame},
               {"default", result.by_default},
               {"substep", result.substep},
               {"speed", result.speed},
               {"iterations", result.iterations},
               {"residual_type", result.residual_type},
               {"times_next", times_next(result)},
               {"curves", Json::array()},
               {"refused", Json::array()}};
  for (const Curve& curve : result.curves) json["curves"].push_back(json_of(curve));
  for (const Refusal& refusal : result.refused)
    json["refused"].push_back({{"sweep", refusal.name}, {"reason", refusal.reason}});
  if (result.budget > 0) {
    json["budget"] = {{"ms_per_frame", result.budget}, {"frames", result.frames}, {"sweeps", Json::array()}};
    for (const Budgeted& row : result.budgeted) json["budget"]["sweeps"].push_back(json_of(row));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pliant::compare
