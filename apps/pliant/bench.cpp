// pliant bench: the workloads of apps/bench as a table, row by row as they are measured.
#include <cstdio>
#include <memory>

#include "apps/bench/bench.h"
#include "atomic_file.h"
#include "command.h"
#include "interrupt.h"
#include "output.h"

namespace pliant::command {

namespace {

constexpr const char* head =
    "workload                 size engine      threads substeps x iter  ms/frame  ns/proj.   stretch mean     p99     max  "
    " ratio\n";

void print_row(const pliant::bench::Row& row) {
  char text[256];
  std::snprintf(text, sizeof text, "%-24s %4d %-11s %7d %8d x %-4d %9.3f %9.2f %14.4f %7.4f %7.4f %7.2f\n",
                row.workload.c_str(), row.size, row.engine.c_str(), row.threads, row.substeps, row.iterations,
                row.ms_per_frame, row.ns_per_projection, row.stretch_mean, row.stretch_p99, row.stretch_max, row.ratio);
  print(text);
  if (!row.met) print("  the bounds were not kept; more substeps than this were not tried\n");
  if (row.energy_lost != 0) {
    std::snprintf(text, sizeof text, "  energy lost by frame 40: %.3g J\n", row.energy_lost);
    print(text);
  }
}

}  // namespace

int bench(const BenchOptions& options) {
  std::unique_ptr<AtomicFile> file;
  if (!options.json.empty()) file = std::make_unique<AtomicFile>(options.json);
  pliant::bench::Options wanted;
  wanted.workload = options.workload;
  if (!options.sizes.empty()) wanted.sizes = options.sizes;
  wanted.frames = options.frames;
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
