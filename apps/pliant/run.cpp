// pliant run: simulates a scene, and writes what was asked for.
//
// Everything that can be refused is refused before the first frame: the formats and places of all files, and the report's
// own.
#include <cstdio>
#include <memory>

#include "atomic_file.h"
#include "command.h"
#include "output.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "run_report.h"
#include "simulate.h"

namespace pliant::command {

namespace {

std::string summary(const RunOptions& options, const World& world, const RunReport& report) {
  char text[160];
  std::snprintf(text, sizeof text, "%lld frames, %.3g ms a frame (95%%: %.3g), %d threads, %s",
                static_cast<long long>(world.state().frame), report.median_milliseconds(), report.p95_milliseconds(),
                world.threads(), world.isa().c_str());
  return one_line(options.scene) + ": " + text + "\nstate " + world.state_hash() + "\n";
}

}  // namespace

int run(const RunOptions& options) {
  std::vector<std::string> files = options.out;
  if (!options.report.empty()) files.push_back(options.report);
  refuse_same_file_twice(options.scene, files);
  const Scene scene = read_scene_with(options.scene, options.overrides, options.quiet);
  World world = make_world(scene, options.scene);

  std::vector<std::unique_ptr<FrameWriter>> writers;
  for (const std::string& path : options.out) writers.push_back(make_frame_writer(path, scene, world));
  std::unique_ptr<AtomicFile> report_file;
  if (!options.report.empty()) report_file = std::make_unique<AtomicFile>(options.report);

  RunReport report(options.hash_frames);
  for (const auto& writer : writers) writer->add(world);
  const bool finite = simulate(world, scene, options.quiet, [&](const Report& frame) {
    report.add(frame, world);
    if (!frame.ok()) return;
    for (const auto& writer : writers) writer->add(world);
  });

  // A run that blew up leaves its report, which says where, and no geometry.
  if (finite) {
    for (const auto& writer : writers) writer->finish();
  }
  if (report_file) {
    report_file->write(report.json(options.scene, scene, world));
    report_file->commit();
  }
  if (!finite) {
    Location where;
    where.file = options.scene;
    throw Error(where, report.last().explain());
  }
  if (!options.quiet) {
    for (const std::string& warning : report.warnings()) print("warning: " + one_line(warning) + "\n");
    print(summary(options, world, report));
  }
  return 0;
}

}  // namespace pliant::command
