// pliant study: runs a scene once for each combination of values, and writes a table with a row for each.
//
// Variants run side by side, each on one thread unless --threads says otherwise, which changes no bits. A variant that
// fails is a row with the reason.
#include "study.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"
#include "apps/command_line/simulate.h"
#include "apps/render/render.h"
#include "command.h"
#include "pliant/error.h"
#include "pliant/save.h"
#include "pliant/version.h"
#include "run_report.h"

namespace pliant::command {

namespace {

using Json = nlohmann::ordered_json;
using render::RenderScene;

/// The columns after those of what is varied; the pointers into the report of `pliant run --report` that fill them.
const std::vector<std::pair<std::string, std::string>> always_measured{
    {"frames", "/frames"},
    {"state_hash", "/state_hash"},
    {"ms_per_frame", "/ms_per_frame/median"},
    {"mean_substeps", "/mean_substeps"},
    {"worst_p99_overstretch", "/overstretch/worst_p99"},
    {"worst_overstretch", "/overstretch/worst_largest"}};

/// What a variant gave.
struct Outcome {
  bool is_ok = false;
  std::vector<std::string> measured;
  std::string problem;
  std::optional<RenderScene> picture;
};

std::vector<std::string> pointers_of(const StudyOptions& options) {
  std::vector<std::string> pointers;
  pointers.reserve(always_measured.size() + options.measures.size());
  for (const auto& [name, pointer] : always_measured) pointers.push_back(pointer);
  pointers.insert(pointers.end(), options.measures.begin(), options.measures.end());
  return pointers;
}

std::vector<std::string> columns_of(const StudyOptions& options, const std::vector<Varied>& varied) {
  std::vector<std::string> columns;
  columns.reserve(varied.size() + always_measured.size() + options.measures.size() + 3);
  for (const Varied& one : varied) columns.push_back(one.pointer);
  columns.emplace_back("fingerprint");
  columns.emplace_back("ok");
  for (const auto& [name, pointer] : always_measured) columns.push_back(name);
  columns.insert(columns.end(), options.measures.begin(), options.measures.end());
  columns.emplace_back("problem");
  return columns;
}

/// The values in a report; empty where it has none.
std::vector<std::string> values_at(const Json& report, const std::vector<std::string>& pointers) {
  std::vector<std::string> values;
  values.reserve(pointers.size());
  for (const std::string& pointer : pointers) {
    const Json::json_pointer at(pointer);
    const Json value = report.contains(at) ? report.at(at) : Json();
    values.push_back(value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump());
  }
  return values;
}

/// Throws an Error if a measure is no JSON pointer.
void check_measures(const StudyOptions& options) {
  for (const std::string& pointer : options.measures) try {
      (void)Json::json_pointer(pointer);
    } catch (const Json::exception&) {
      throw Error({}, "'" + pointer + "' is no JSON pointer",
                  "write a member of the report of a run, as /overstretch/p99");
    }
}

SceneFile file_of(const StudyOptions& options, const Variant& variant, bool is_alone) {
  Overrides overrides = options.overrides;
  overrides.values.insert(overrides.values.end(), variant.begin(), variant.end());
  if (!is_alone && !overrides.threads) overrides.threads = 1;
  return read_file_with(options.scene, overrides, true);
}

/// What decides the results of a variant, in 16 digits: the scene, its frames, and the version of Pliant. Empty if the
/// scene cannot be read.
std::string fingerprint_of(const StudyOptions& options, const Variant& variant) {
  try {
    const Scene scene = file_of(options, variant, false).scene;
    const Fingerprint of = fingerprint(scene);
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a
    for (const char c : of.scene + of.settings + std::to_string(scene.frames) + PLIANT_VERSION)
      hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    return fmt::format("{:016x}", hash);
  } catch (const Error&) {
    return {};
  }
}

Outcome simulate_variant(const StudyOptions& options, const Variant& variant, bool is_alone) {
  const SceneFile file = file_of(options, variant, is_alone);
  World world = make_world(file.scene, options.scene);
  RunReport report(false);
  const bool finite = simulate(world, file.scene, true, [&](const Report& frame) { report.add(frame, world); });
  Outcome outcome;
  outcome.is_ok = finite;
  outcome.measured = values_at(Json::parse(report.json(options.scene, file.scene, world)), pointers_of(options));
  if (!finite) outcome.problem = report.last().explain();
  if (finite && !options.pictures.empty()) outcome.picture = render::make_render_scene(file.scene, world);
  return outcome;
}

/// The outcome of a variant; one that fails has the reason.
Outcome outcome_of(const StudyOptions& options, const Variant& variant, bool is_alone) {
  try {
    return simulate_variant(options, variant, is_alone);
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    Outcome outcome;
    outcome.measured.resize(pointers_of(options).size());
    outcome.problem = error.what();
    return outcome;
  }
}

std::vector<std::string> key_of(const Variant& variant, const std::vector<Varied>& varied) {
  std::vector<std::string> key;
  key.reserve(variant.size() + 1);
  for (std::size_t i = 0; i < variant.size(); ++i) key.push_back(variant[i].substr(varied[i].pointer.size() + 1));
  return key;
}

/// `start`: the values and the fingerprint.
std::vector<std::string> row_of(std::vector<std::string> key, const Outcome& outcome) {
  key.emplace_back(outcome.is_ok ? "true" : "false");
  key.insert(key.end(), outcome.measured.begin(), outcome.measured.end());
  key.push_back(one_line(outcome.problem));
  return key;
}

/// Runs what is left to do on `jobs` threads. Rethrows the first exception, after all have ended.
void run_side_by_side(std::size_t count, std::size_t jobs, const std::function<void(std::size_t)>& run_one) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr first;
  std::mutex guard;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) run_one(i);
    } catch (...) {
      next = count;
      const std::scoped_lock lock(guard);
      if (first == nullptr) first = std::current_exception();
    }
  };
  std::vector<std::jthread> threads;
  threads.reserve(jobs);
  for (std::size_t i = 1; i < jobs; ++i) threads.emplace_back(work);
  work();
  threads.clear();  // joins them
  if (first != nullptr) std::rethrow_exception(first);
}

/// Draws the last frame of each variant, from one camera, into one picture: as many to a row as the last member has
/// values. Those that failed stay white.
void draw_sheet(const StudyOptions& options, const std::vector<std::optional<RenderScene>>& pictures,
                std::size_t columns, const SceneCamera& seen_from) {
  constexpr int width = 320, height = 240, gap = 4;
  const std::size_t rows = (pictures.size() + columns - 1) / columns;
  const auto whole = [](std::size_t count, int size) { return static_cast<int>(count) * (size + gap) - gap; };
  const int full_width = whole(columns, width), full_height = whole(rows, height);
  std::vector<RenderScene> scenes;
  scenes.reserve(pictures.size());
  for (const std::optional<RenderScene>& one : pictures)
    if (one) scenes.push_back(*one);
  if (scenes.empty()) throw Error({}, "there is nothing to draw: no variant succeeded", "see the column \"problem\"");
  const render::Camera camera = render::frame_camera(scenes, width, height, seen_from);
  const render::Extent extent = render::extent_of(scenes);
  render::Renderer renderer(width, height);
  const std::size_t row_bytes = std::size_t{3} * static_cast<std::size_t>(full_width);
  std::vector<std::uint8_t> sheet(row_bytes * static_cast<std::size_t>(full_height), 255);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (!pictures[i]) continue;
    RenderScene scene = *pictures[i];
    scene.camera = camera;
    scene.extent = extent;
    const std::vector<std::uint8_t> pixels = renderer.draw(scene);
    const std::size_t left = (i % columns) * std::size_t{3} * (width + gap), top = (i / columns) * (height + gap);
    for (std::size_t y = 0; y < height; ++y)
      std::copy_n(pixels.begin() + static_cast<std::ptrdiff_t>(y * 3 * width), 3 * width,
                  sheet.begin() + static_cast<std::ptrdiff_t>((top + y) * row_bytes + left));
  }
  render::write_png(options.pictures, full_width, full_height, sheet);
}

/// Throws an Error for files that cannot be written, or a scene that cannot be read. Returns the scene's camera.
SceneCamera check_study(const StudyOptions& options) {
  check_measures(options);
  std::vector<std::string> files{options.out};
  if (!options.pictures.empty()) files.push_back(options.pictures);
  if (!options.pictures.empty() && !has_suffix(options.pictures, ".png"))
    throw Error({}, "--pictures " + options.pictures + " is no .png", "give a name that ends in .png");
  refuse_same_file_twice({options.scene}, files);
  for (const std::string& file : files) refuse_unwritable(file);
  SceneCamera camera = read_file_with(options.scene, options.overrides, options.quiet).camera;
  for (const std::string& file : files) make_folder_of(file);
  return camera;
}

}  // namespace

int study(const StudyOptions& options) {
  std::vector<Varied> varied;
  varied.reserve(options.vary.size());
  for (const std::string& text : options.vary) varied.push_back(parse_varied(text));
  const std::vector<Variant> variants = combinations(varied);
  const SceneCamera camera = check_study(options);
  constexpr std::size_t most_pictures = 400;
  if (!options.pictures.empty() && variants.size() > most_pictures)
    throw Error({}, "--pictures would draw " + std::to_string(variants.size()) + " pictures",
                "draw at most " + std::to_string(most_pictures));
  StudyTable table(options.out, columns_of(options, varied), varied.size(), variants.size());
  std::vector<std::size_t> left;
  std::vector<std::vector<std::string>> starts(variants.size());
  for (std::size_t i = 0; i < variants.size(); ++i) {
    starts[i] = key_of(variants[i], varied);
    starts[i].push_back(fingerprint_of(options, variants[i]));
    if (!table.take_over(i, starts[i]) || !options.pictures.empty()) left.push_back(i);
  }
  std::vector<std::optional<RenderScene>> pictures(options.pictures.empty() ? 0 : variants.size());
  std::mutex guard;
  std::size_t failed = 0;
  const std::size_t wanted = options.jobs > 0 ? static_cast<std::size_t>(options.jobs)
                                              : std::max<std::size_t>(std::thread::hardware_concurrency(), 1);
  const std::size_t jobs = std::min(wanted, std::max<std::size_t>(left.size(), 1));
  const auto run_one = [&](std::size_t i) {
    const std::size_t number = left[i];
    Outcome outcome = outcome_of(options, variants[number], jobs == 1);
    const std::scoped_lock lock(guard);
    failed += outcome.is_ok ? 0 : 1;
    table.set(number, row_of(starts[number], outcome));
    if (!pictures.empty()) pictures[number] = std::move(outcome.picture);
  };
  try {
    run_side_by_side(left.size(), jobs, run_one);
  } catch (...) {
    table.write();
    throw;
  }
  table.write();
  if (!pictures.empty()) draw_sheet(options, pictures, varied.empty() ? 1 : varied.back().values.size(), camera);
  if (!options.quiet) {
    print(counted(variants.size(), "variant") + ", " + std::to_string(variants.size() - left.size()) +
          " of them from an earlier table, " + std::to_string(failed) + " failed; wrote " + one_line(options.out) +
          (options.pictures.empty() ? "" : " and " + one_line(options.pictures)) + "\n");
  }
  return failed == 0 ? 0 : 1;
}

}  // namespace pliant::command
