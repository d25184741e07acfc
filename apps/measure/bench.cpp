// pliant bench: measures the workloads of apps/bench, and prints each row of a table when it is measured.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "apps/bench/bench.h"
#include "apps/bench/chains.h"
#include "apps/bench/columns.h"
#include "apps/bench/contact.h"
#include "apps/bench/covered.h"
#include "apps/bench/draped_meshes.h"
#include "apps/bench/known_sags.h"
#include "apps/bench/landing.h"
#include "apps/bench/liquid.h"
#include "apps/bench/memory.h"
#include "apps/bench/piles.h"
#include "apps/bench/scene_table.h"
#include "apps/bench/soft_bodies.h"
#include "apps/bench/tears.h"
#include "apps/command_line/give_back.h"
#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"
#include "apps/command_line/simulate.h"
#include "apps/command_line/usage.h"
#include "apps/measure/measure.h"
#include "atomic_file.h"

namespace pliant::command {

namespace {

constexpr int usual_frames = 120;
constexpr const char* head =
    "workload                 size engine      threads substeps x iter  ms/frame  ns/proj.   stretch mean     p99     "
    "max  "
    " ratio\n";

void print_row(const pliant::bench::Row& row) {
  char text[256];
  std::snprintf(text, sizeof text, "%-24s %4d %-11s %7d %8d x %-4d %9.3f %9.2f %14.4f %7.4f %7.4f %7.2f\n",
                row.workload.c_str(), row.size, row.engine.c_str(), row.threads, row.substeps, row.iterations,
                row.ms_per_frame, row.ns_per_projection, row.stretch_mean, row.stretch_p99, row.stretch_max, row.ratio);
  print(text);
  std::string phases;
  for (const PhaseTime& phase : row.phases)
    phases += fmt::format("{}{} {:.3f}", phases.empty() ? "" : ", ", phase.name, phase.milliseconds);
  if (!phases.empty()) print("  by phase, ms: " + phases + "\n");
  if (!row.met) print("  the bounds were exceeded at the largest number of substeps that is tried\n");
  if (row.energy_lost != 0) {
    std::snprintf(text, sizeof text, "  energy lost by frame 40: %.3g J\n", row.energy_lost);
    print(text);
  }
}

std::string bench_contact(const BenchOptions& options) {
  pliant::bench::ContactOptions wanted;
  if (!options.sizes.empty()) wanted.sizes = options.sizes;
  wanted.frames = options.frames.value_or(usual_frames);
  print("size  particles  without, ms  with, ms  ratio  slowest, ms  us/particle  candidates/particle  lists/frame\n");
  wanted.on_row = [](const pliant::bench::ContactRow& row) {
    throw_if_interrupted();
    char text[256];
    std::snprintf(text, sizeof text, "%4d %10d %12.2f %9.2f %6.2f %12.2f %12.3f %20.1f %12.0f\n", row.size,
                  row.particles, row.without_ms, row.with_ms, row.ratio, row.largest_ms, row.with_us_per_particle,
                  row.candidates_per_particle, row.lists);
    print(text);
  };
  return to_json(pliant::bench::measure_contact(wanted));
}

std::string bench_memory(const BenchOptions& options) {
  const GiveBackMemory as_run_does;
  pliant::bench::MemoryOptions wanted;
  if (!options.sizes.empty()) wanted.sizes = options.sizes;
  print("size  sweep      bytes a particle: peak  given away  scene  scene peak   world\n");
  wanted.on_row = [](const pliant::bench::MemoryRow& row) {
    throw_if_interrupted();
    print(fmt::format("{:4}  {:<10} {:22.0f} {:11.0f} {:6.0f} {:11.0f} {:7.0f}\n", row.size, sweep_name(row.sweep),
                      row.peak, row.peak_given_away, row.scene, row.scene_peak, row.world));
  };
  return to_json(pliant::bench::measure_memory(wanted));
}

std::string bench_landings(const BenchOptions& options) {
  pliant::bench::LandingOptions wanted;
  if (options.workload != "W3") wanted.on = {options.workload.substr(std::string("W3-").size())};
  if (!options.sizes.empty()) wanted.sizes = options.sizes;
  wanted.frames = options.frames.value_or(usual_frames);
  wanted.limit = options.limit;
  wanted.against_bullet = options.against == "bullet";
  print(
      "on     size  engine              substeps x iter  frames  mean, ms  median, ms  slowest, ms  stretch    p99  "
      "crossings   ratio\n");
  wanted.on_row = [](const pliant::bench::LandingRow& row) {
    throw_if_interrupted();
    char text[256];
    std::snprintf(text, sizeof text, "%-5s %5d  %-18s %9d x %-4d %7d %9.2f %11.2f %12.2f %8.4f %6.3f %10zu %7.2f%s\n",
                  row.on.c_str(), row.size, row.engine.c_str(), row.substeps, row.iterations, row.frames, row.mean_ms,
                  row.median_ms, row.largest_ms, row.stretch_mean, row.stretch_p99, row.crossings, row.ratio,
                  row.in_time ? "" : "  out of time");
    print(text);
  };
  return to_json(pliant::bench::measure_landings(wanted));
}

std::string bench_bodies(const BenchOptions& options) {
  pliant::bench::PileOptions wanted;
  if (options.workload != "bodies") wanted.piles = {options.workload.substr(std::string("bodies-").size())};
  wanted.sizes = options.sizes;
  wanted.frames = options.frames.value_or(wanted.frames);
  wanted.limit = options.limit;
  wanted.against_bullet = options.against == "bullet";
  print(
      "pile      size  bodies  engine          threads  substeps  mean, ms  slowest, ms  real-time    ratio  "
      "after frame: moved, m; fastest, m/s; lost\n");
  wanted.on_row = [](const pliant::bench::PileRow& row) {
    throw_if_interrupted();
    std::string snapshots;
    for (const pliant::bench::PileSnapshot& snapshot : row.snapshots)
      snapshots +=
          fmt::format("  {}: {:.3g}; {:.2g}; {}", snapshot.frame, snapshot.moved, snapshot.speed, snapshot.lost);
    print(fmt::format("{:<8} {:5} {:7}  {:<14} {:8} {:9} {:9.3f} {:12.2f} {:10.2f} {:8.2f}{}\n", row.pile, row.size,
                      row.bodies, row.engine, row.threads, row.substeps, row.mean_ms, row.largest_ms,
                      1000. / 60 / row.mean_ms, row.ratio, snapshots));
  };
  return to_json(pliant::bench::measure_piles(wanted));
}

std::string bench_covered(const BenchOptions& options) {
  pliant::bench::CoveredOptions wanted;
  if (!options.sizes.empty()) wanted.sizes = options.sizes;
  wanted.frames = options.frames.value_or(wanted.frames);
  print("what          size  bodies  mean, ms  median, ms  slowest, ms  ratio  crossings: worst; frames; unnamed\n");
  wanted.on_row = [](const pliant::bench::CoveredRow& row) {
    throw_if_interrupted();
    print(fmt::format("{:<12} {:5} {:7} {:9.3f} {:11.3f} {:12.2f} {:6.2f}  {}; {}; {}\n", row.what, row.size,
                      row.bodies, row.mean_ms, row.median_ms, row.largest_ms, row.ratio, row.worst_crossings,
                      row.frames_with_crossings, row.unnamed));
  };
  return to_json(pliant::bench::measure_covered(wanted));
}

std::string bench_joints(const BenchOptions& options) {
  pliant::bench::ChainOptions wanted;
  if (!options.sizes.empty()) wanted.sizes = options.sizes;
  wanted.frames = options.frames.value_or(wanted.frames);
  print("links  solver  substeps  ms/frame  drift, mm  ratio\n");
  wanted.on_row = [](const pliant::bench::ChainRow& row) {
    throw_if_interrupted();
    print(fmt::format("{:5}  {:<6} {:9} {:9.4f} {:10.4f} {:6.3f}\n", row.links, row.solver, row.substeps,
                      row.ms_per_frame, 1000 * row.drift, row.ratio));
  };
  return to_json(pliant::bench::measure_chains(wanted));
}

std::string bench_liquids(const BenchOptions& options) {
  pliant::bench::LiquidOptions wanted;
  if (!options.sizes.empty()) wanted.sizes = options.sizes;
  wanted.frames = options.frames.value_or(wanted.frames);
  print(
      "particles  engine       isa         substeps  median, ms  slowest, ms  ns/particle  search  compression   ratio "
      " "
      "bytes/particle  surface/step\n");
  wanted.on_row = [](const pliant::bench::LiquidRow& row) {
    throw_if_interrupted();
    print(fmt::format("{:9}  {:<11}  {:<10} {:9} {:11.2f} {:12.2f} {:12.2f} {:6.1f}% {:11.3f}% {:7.2f}", row.particles,
                      row.engine, row.isa, row.substeps, row.median_ms, row.largest_ms, row.ns_per_particle,
                      100 * row.search, 100 * row.compression, row.ratio));
    print(row.bytes > 0 ? fmt::format(" {:15.0f} {:13.2f}\n", row.bytes, row.surface) : "\n");
  };
  return to_json(pliant::bench::measure_liquids(wanted));
}

std::string bench_soft_bodies(const BenchOptions& options) {
  pliant::bench::SoftBodyBenchOptions wanted;
  if (!options.sizes.empty()) wanted.sizes = options.sizes;
  wanted.frames = options.frames.value_or(wanted.frames);
  print(
      "cells  tetrahedra  material           engine       substeps  ms/frame  ns/proj.   ratio  inverted  worst volume "
      " "
      "set-up, ms\n");
  wanted.on_row = [](const pliant::bench::SoftBodyRow& row) {
    throw_if_interrupted();
    print(fmt::format("{:5}  {:10}  {:<17}  {:<11} {:9} {:9.2f} {:9.2f} {:7.2f} {:9} {:13.3f} {:11.0f}\n", row.cells,
                      row.tetrahedra, row.material, row.engine, row.substeps, row.median_ms, row.ns, row.ratio,
                      row.inverted, row.worst, row.set_up_ms));
  };
  return to_json(pliant::bench::measure_soft_bodies(wanted));
}

std::string bench_columns(const BenchOptions& options) {
  pliant::bench::ColumnOptions wanted;
  if (!options.sizes.empty()) wanted.depths = options.sizes;
  wanted.frames = options.frames.value_or(wanted.frames);
  print(
      "depth, m  spacing, m  particles  substeps x iter.  denser: mean  largest  speed, mm/s: mean  largest  height  "
      "ns  "
      "ms/1000 particles\n");
  wanted.on_row = [](const pliant::bench::ColumnRow& row) {
    throw_if_interrupted();
    print(fmt::format(
        "{:8}  {:10}  {:9}  {:8} x {:<5}{:<1}  {:10.3f}%  {:6.2f}%  {:16.2f}  {:7.1f}  {:6.4f}  {:2.0f}  {:.3f}\n",
        row.depth, row.spacing, row.particles, row.substeps, row.iterations, row.is_default ? "d" : "", 100 * row.mean,
        100 * row.largest, 1000 * row.speed, 1000 * row.fastest, row.height, row.ns, row.ms_per_1000));
  };
  return to_json(pliant::bench::measure_columns(wanted));
}

std::string bench_tears(const BenchOptions& options) {
  pliant::bench::TearOptions wanted;
  if (!options.sizes.empty()) wanted.sizes = options.sizes;
  wanted.frames = options.frames.value_or(wanted.frames);
  print(
      "object  cells  elements  substeps  cuts  new particles  ms: whole     cut  ratio  us/new particle  "
      "ns/element\n");
  wanted.on_row = [](const pliant::bench::TearRow& row) {
    throw_if_interrupted();
    print(fmt::format("{:<6}  {:5}  {:8}  {:8}  {:4}  {:13.1f}  {:9.2f}  {:6.2f}  {:5.2f}  {:15.1f}  {:10.0f}\n",
                      row.object, row.cells, row.elements, row.substeps, row.cuts, row.copies, row.whole_ms, row.cut_ms,
                      row.ratio, row.us_per_copy, row.ns_per_element));
  };
  return to_json(pliant::bench::measure_tears(wanted));
}

std::string bench_default(const BenchOptions& options) {
  if (!options.sizes.empty())
    throw Error({}, "'default' takes no --sizes, because its scenes have their own", "leave out --sizes");
  pliant::bench::SceneTableOptions wanted;
  if (options.settings == std::vector<std::string>{"none"})
    wanted.against.clear();
  else if (!options.settings.empty())
    wanted.against = options.settings;
  pliant::bench::refuse_unknown_settings(wanted.against);
  std::vector<pliant::bench::NamedScene> scenes;
  for (const std::string& path : options.scenes) {
    scenes.push_back({path, read_scene_with(path, {}, true)});
    refuse_tears(scenes.back().scene, path, "this benchmark");
  }
  if (!options.meshes.empty())
    for (pliant::bench::NamedScene& draped : pliant::bench::draped_meshes(options.meshes))
      scenes.push_back(std::move(draped));
  if (options.scenes.empty() && options.meshes.empty()) scenes = pliant::bench::known_sags();
  wanted.frames = options.frames.value_or(0);
  wanted.counts_crossings = !options.meshes.empty();
  print(
      "scene                          settings           substeps  ms/frame  p99, % (frame)  largest, % (frame)  gain, "
      "J/kg (with bending)  moved, mm  crossings  yield  ratio to the cheapest that holds\n");
  const bool compares = !wanted.against.empty();
  wanted.on_row = [compares](const pliant::bench::SceneRow& row) {
    throw_if_interrupted();
    const std::string cost = row.settings != "default" || !compares ? ""
                             : row.cheapest.empty()                 ? "  no named one holds"
                                                    : fmt::format("  {:.2f} to '{}'", row.ratio, row.cheapest);
    print(fmt::format(
        "{:<30} {:<18} {:8.1f} {:9.2f} {:8.2f} {:<7} {:11.2f} {:<8} {:10.4f} {:<9} {:10.4f}  {:>9}  {:>5}{}{}\n",
        row.scene, row.settings, row.substeps, row.milliseconds, 100 * row.p99, fmt::format("({})", row.frame_of_p99),
        100 * row.largest, fmt::format("({})", row.frame_of_largest), row.gain,
        fmt::format("({:.4f})", row.gain_with_bending), 1000 * row.moved,
        row.crossings < 0 ? "-" : std::to_string(row.crossings),
        row.yield == 0 ? "-" : fmt::format("{:.3f}", row.yield), cost, row.finite ? "" : "  not finite"));
  };
  return to_json(pliant::bench::measure_scenes(scenes, wanted));
}

/// Throws an Error with a similar name if there is no such workload.
void refuse_unknown(const std::string& workload) {
  std::vector<std::string> names;
  for (const pliant::bench::Workload& frames : pliant::bench::workloads()) names.push_back(frames.name);
  for (const char* other : {"bodies", "bodies-pyramid", "bodies-tower", "bodies-pour", "columns", "contact", "covered",
                            "default", "joints", "memory", "tears", "W2", "W3", "W3-ball", "W3-cloth", "W5"})
    names.emplace_back(other);
  if (workload.empty() || std::find(names.begin(), names.end(), workload) != names.end()) return;
  throw Error({}, "there is no workload '" + workload + "'",
              did_you_mean(workload, names) + "the workloads are " + joined(names));
}

/// Only liquids are counted by particles; what others count by sides or rows has a lower limit.
void refuse_large(const BenchOptions& options) {
  constexpr int largest = 100000;
  if (options.workload == "W5" || options.sizes.empty()) return;
  const int size = *std::max_element(options.sizes.begin(), options.sizes.end());
  if (size > largest)
    throw Error({}, "--sizes: " + std::to_string(size) + " is more than " + std::to_string(largest),
                "give a smaller size; only W5 takes more");
}

/// Measures a workload that has rows of its own, and returns them as JSON; nullopt for other workloads.
std::optional<std::string> bench_by_name(const BenchOptions& options) {
  if (options.workload.rfind("bodies", 0) == 0) return bench_bodies(options);
  if (options.workload == "columns") return bench_columns(options);
  if (options.workload == "contact") return bench_contact(options);
  if (options.workload == "covered") return bench_covered(options);
  if (options.workload == "default") return bench_default(options);
  if (options.workload == "joints") return bench_joints(options);
  if (options.workload == "memory") return bench_memory(options);
  if (options.workload == "tears") return bench_tears(options);
  if (options.workload == "W3" || options.workload == "W3-ball" || options.workload == "W3-cloth")
    return bench_landings(options);
  if (options.workload == "W2") return bench_soft_bodies(options);
  if (options.workload == "W5") return bench_liquids(options);
  return std::nullopt;
}

}  // namespace

int bench(const BenchOptions& options) {
  refuse_unknown(options.workload);
  refuse_large(options);
  std::unique_ptr<AtomicFile> file;
  if (!options.json.empty()) file = std::make_unique<AtomicFile>(options.json);
  if (const auto json = bench_by_name(options)) {
    throw_if_interrupted();
    if (!file) return 0;
    file->write(*json);
    file->commit();
    return 0;
  }
  pliant::bench::Options wanted;
  wanted.workload = options.workload;
  if (!options.sizes.empty()) wanted.sizes = options.sizes;
  wanted.frames = options.frames.value_or(usual_frames);
  wanted.threads = options.threads;
  wanted.against_bullet = options.against == "bullet";
  bool first = true;
  wanted.on_row = [&](const pliant::bench::Row& row) {
    throw_if_interrupted();
    if (first) print(head);
    first = false;
    print_row(row);
  };
  const auto rows = pliant::bench::run(wanted);
  throw_if_interrupted();
  if (file) {
    file->write(pliant::bench::to_json(rows));
    file->commit();
  }
  return 0;
}

}  // namespace pliant::command
