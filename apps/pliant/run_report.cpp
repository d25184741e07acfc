#include "run_report.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "apps/command_line/figure.h"
#include "io/report_parts.h"
#include "pliant/version.h"

namespace pliant::command {

namespace {

using report_parts::Json;

Json constraints_by_type(const World& world) {
  std::map<std::string, std::int64_t> sums;
  for (int object = 0; object < world.object_count(); ++object) {
    for (const auto& [type, count] : world.object(object).info().constraints) sums[type] += count;
  }
  return sums;
}

std::int64_t particle_count(const World& world) {
  std::int64_t count = 0;
  for (int object = 0; object < world.object_count(); ++object) count += world.object(object).info().particles;
  return count;
}

Json residuals_json(const World& world) {
  Json json = Json::object();
  for (const Residual& residual : world.measure().residuals()) {
    json[residual.type] = {{"constraints", residual.constraints}, {"rms", residual.rms}, {"largest", residual.largest}};
  }
  return json;
}

/// Adds the figures of a frame to `sum`: counts are added up, momentary values replaced.
void add_pairs(PairReport& sum, const PairReport& frame) {
  sum.candidates = frame.candidates;
  sum.contacts = frame.contacts;
  sum.initially_intersecting = frame.initially_intersecting;
  sum.inside = frame.inside;
  sum.deepest = frame.deepest;
  sum.truncated += frame.truncated;
  sum.unresolvable += frame.unresolvable;
  sum.rebuilds += frame.rebuilds;
}

Json overstretch_json(const Report& report) {
  const Overstretch last = report.overstretch.value_or(Overstretch{});
  const WorstOverstretch& worst = report.worst_overstretch;
  return {{"p99", last.p99},
          {"largest", last.largest},
          {"worst_p99", worst.overstretch.p99},
          {"frame_of_worst_p99", worst.frame_of_p99},
          {"worst_largest", worst.overstretch.largest},
          {"frame_of_worst_largest", worst.frame_of_largest}};
}

/// The rigid tie that was open farthest in any frame; null without one.
Json tie_json(const World& world, const TieGap& tie, std::int64_t frame) {
  Json json = report_parts::tie_json(world, tie);
  if (!json.is_null()) json["frame"] = frame;
  return json;
}

/// How much denser than at rest liquids were; null without a liquid.
Json compression_json(const Scene& scene, const Compression& last, const Compression& worst, std::int64_t frame_of_mean,
                      std::int64_t frame_of_largest) {
  const auto is_liquid = [](const Object& object) { return object.fluid && !object.gas; };
  if (std::none_of(scene.objects.begin(), scene.objects.end(), is_liquid)) return nullptr;
  return {{"mean", last.mean},
          {"largest", last.largest},
          {"worst_mean", worst.mean},
          {"frame_of_worst_mean", frame_of_mean},
          {"worst_largest", worst.largest},
          {"frame_of_worst_largest", frame_of_largest},
          {"crowded", last.crowded}};
}

/// How many particles came and went in all frames; null if none can.
Json flow_json(const Scene& scene, const FlowReport& flow) {
  const auto flows = [](const Object& object) { return object.flow.is_used() || object.absorbency; };
  if (std::none_of(scene.objects.begin(), scene.objects.end(), flows)) return nullptr;
  return report_parts::flow_json(flow);
}

/// How often what tore, and when at first; null if nothing can tear.
Json tears_json(const Scene& scene, const Tears& tears) {
  if (std::none_of(scene.objects.begin(), scene.objects.end(), comes_apart)) return nullptr;
  return {{"new_particles", tears.new_particles},
          {"lost_constraints", tears.lost_constraints},
          {"broken_joints", tears.broken_joints},
          {"first_frame", tears.first_frame < 0 ? Json() : Json(tears.first_frame)}};
}

/// The tetrahedra of soft bodies at the end, and in their worst frame; null without any.
Json tetrahedra_json(const World& world, const TetrahedraMeasure& worst, std::int64_t frame) {
  const TetrahedraMeasure last = world.measure().tetrahedra();
  if (last.tetrahedra == 0) return nullptr;
  return {{"count", last.tetrahedra},         {"inverted", last.inverted},
          {"least_ratio", last.least_ratio},  {"volume_ratio", last.volume_ratio},
          {"worst_inverted", worst.inverted}, {"worst_least_ratio", worst.least_ratio},
          {"frame_of_worst", frame}};
}

std::size_t body_count(const Scene& scene) {
  std::size_t count = 0;
  for (const Object& object : scene.objects) count += object.bodies.size();
  return count;
}

/// Adds the number of substeps, the largest of any object; if objects differ, also that of each. Where they follow the
/// State that is 0, and the largest is that of any frame.
void add_substeps(const World& world, int most_of_frames, Json& json) {
  int most = world.settings().substeps;
  Json by_object = Json::object();
  for (const ObjectId id : world.objects()) {
    const ObjectInfo info = world.object(id).info();
    by_object[info.name] = info.substeps;
    most = std::max(most, info.substeps > 0 ? info.substeps : most_of_frames);
  }
  json["substeps"] = most;
  if (world.settings().substeps == 0) json["substeps_by_object"] = by_object;
}

}  // namespace

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(place));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

void RunReport::add(const Report& report, const World& world) {
  last_ = report;
  iterations_.smallest =
      milliseconds_.empty() ? report.iterations.smallest : std::min(iterations_.smallest, report.iterations.smallest);
  iterations_.largest = std::max(iterations_.largest, report.iterations.largest);
  add_pairs(pairs_, report.pairs);
  lost_momentum_ += report.lost_momentum;
  if (report.widest_tie.gap * widest_tie_.length > widest_tie_.gap * report.widest_tie.length || widest_tie_.body < 0) {
    widest_tie_ = report.widest_tie;
    frame_of_tie_ = report.frame;
  }
  add(report.compression, report.frame);
  add(world.measure().tetrahedra(), report.frame);
  flow_.add(report.flow);
  for (const Torn& torn : report.torn) {
    tears_.new_particles += torn.new_particles;
    tears_.lost_constraints += torn.lost_constraints;
  }
  tears_.broken_joints += static_cast<std::int64_t>(report.broken_joints.size());
  if (tears_.first_frame < 0 && !(report.torn.empty() && report.broken_joints.empty()))
    tears_.first_frame = report.frame;
  iterations_.mean += report.iterations.mean;
  milliseconds_.push_back(report.milliseconds);
  most_substeps_ = std::max(most_substeps_, report.substeps);
  sum_of_substeps_ += report.substeps;
  for (const PhaseTime& phase : report.phases) phase_sums_[phase.name] += phase.milliseconds;
  if (hash_frames_) hashes_.push_back(world.state_hash());
  warnings_.add(report);
}

void RunReport::add(const Compression& compression, std::int64_t frame) {
  if (compression.mean > worst_compression_.mean) {
    worst_compression_.mean = compression.mean;
    frame_of_mean_ = frame;
  }
  if (compression.largest > worst_compression_.largest) {
    worst_compression_.largest = compression.largest;
    frame_of_largest_ = frame;
  }
}

void RunReport::add(const TetrahedraMeasure& tetrahedra, std::int64_t frame) {
  const auto rank = [](const TetrahedraMeasure& of) { return std::pair{-of.inverted, of.least_ratio}; };
  if (frame_of_tetrahedra_ > 0 && rank(tetrahedra) >= rank(worst_tetrahedra_)) return;
  worst_tetrahedra_ = tetrahedra;
  frame_of_tetrahedra_ = frame;
}

std::vector<std::string> RunReport::warnings(const World& world) const {
  constexpr double tolerated = 0.01;
  std::vector<std::string> lines = warnings_.lines();
  if (worst_compression_.mean > tolerated)
    lines.push_back(
        "in frame " + std::to_string(frame_of_mean_) + ", liquids were " + figure(100 * worst_compression_.mean, 2) +
        " % denser than at rest on average; use more substeps, which compress a liquid by the square of their "
        "length, or a higher speed_of_sound if it has one");
  if (worst_tetrahedra_.inverted > 0)
    lines.push_back("in frame " + std::to_string(frame_of_tetrahedra_) + ", " +
                    std::to_string(worst_tetrahedra_.inverted) + " of " + std::to_string(worst_tetrahedra_.tetrahedra) +
                    " tetrahedra were turned inside out; use more substeps");
  std::vector<std::string> said = lines;
  said.push_back(advice(world));
  const std::vector<std::string> soft = unconverged(world, last_.worst_estimates, said);
  lines.insert(lines.end(), soft.begin(), soft.end());
  return lines;
}

std::string RunReport::advice(const World& world) const {
  const WorstOverstretch& worst = last_.worst_overstretch;
  const std::string words = world.measure().advice(worst.overstretch);
  return words.empty() ? words : "in frame " + std::to_string(worst.frame_of_largest) + ", " + words;
}

namespace {

/// The sweep of all objects; `automatic` if they differ.
Sweep sweep_of(const World& world) {
  const WorldLayout layout = world.layout();
  std::set<Sweep> sweeps;
  for (const WorldLayout::Slot& object : layout.objects)
    if (object.number >= 0) sweeps.insert(layout.sweeps[static_cast<std::size_t>(object.number)]);
  return sweeps.empty() ? world.settings().sweep : sweeps.size() == 1 ? *sweeps.begin() : Sweep::automatic;
}

}  // namespace

std::string RunReport::json(const std::string& scene_path, const Scene& scene, const World& world) const {
  const Stretch stretch = world.measure().stretch();
  const double frames = static_cast<double>(std::max<std::size_t>(milliseconds_.size(), 1));
  Json json;
  json["pliant"] = PLIANT_VERSION;
  json["scene"] = scene_path;
  json["state_hash"] = world.state_hash();
  json["frames"] = world.state().frame;
  json["frame_time"] = scene.frame_time;
  json["sweep"] = sweep_name(sweep_of(world));
  add_substeps(world, most_substeps_, json);
  json["mean_substeps"] = static_cast<double>(sum_of_substeps_) / frames;
  json["iterations"] = world.settings().iterations;
  json["iterations_used"] = {
      {"smallest", iterations_.smallest}, {"largest", iterations_.largest}, {"mean", iterations_.mean / frames}};
  json["particles"] = particle_count(world);
  json["bodies"] = body_count(scene);
  json["sleeping_bodies"] = last_.sleeping_bodies;
  json["sleeping_grains"] = last_.sleeping_grains;
  json["constraints"] = constraints_by_type(world);
  json["contacts"] = last_.contacts;
  json["pairs"] = report_parts::pairs_json(pairs_);
  json["lost_momentum"] = report_parts::lost_momentum_json(lost_momentum_);
  json["ms_per_frame"] = {{"median", median_milliseconds()}, {"p95", p95_milliseconds()}};
  json["phases_ms"] = Json::object();
  for (const auto& [phase, sum] : phase_sums_) json["phases_ms"][phase] = sum / frames;
  json["residual"] = residuals_json(world);
  json["max_stretch"] = stretch.largest;
  json["mean_stretch"] = stretch.mean;
  json["p99_stretch"] = stretch.p99;
  json["overstretch"] = overstretch_json(last_);
  json["convergence"] = report_parts::estimates_json(world, last_);
  json["widest_tie"] = tie_json(world, widest_tie_, frame_of_tie_);
  json["flow"] = flow_json(scene, flow_);
  json["tears"] = tears_json(scene, tears_);
  json["compression"] =
      compression_json(scene, last_.compression, worst_compression_, frame_of_mean_, frame_of_largest_);
  json["tetrahedra"] = tetrahedra_json(world, worst_tetrahedra_, frame_of_tetrahedra_);
  json["nonfinite"] = report_parts::nonfinite_json(last_);
  json["warnings"] = warnings(world);
  json["advice"] = advice(world);
  json["threads"] = world.threads();
  json["isa"] = world.isa();
  if (hash_frames_) json["frame_hashes"] = hashes_;
  // Invalid UTF-8 is replaced, because a path or a name may contain it.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pliant::command
