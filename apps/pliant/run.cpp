// pliant run: simulates a scene, and writes what was asked for.
//
// Everything that can be refused is refused before the first frame: the formats and places of all files, and the report's
// own.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "atomic_file.h"
#include "command.h"
#include "output.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "run_report.h"
#include "simulate.h"

namespace pliant::command {

namespace {

/// One name for one file: "a", "./a" and a link to it are the same, and what is written must not replace what was read.
std::string file_itself(const std::string& path) {
  std::error_code unknown;
  const std::filesystem::path place = std::filesystem::absolute(path, unknown);
  const std::filesystem::path resolved = unknown ? place : std::filesystem::weakly_canonical(place, unknown);
  return unknown ? path : resolved.string();
}

void refuse_same_file_twice(const RunOptions& options) {
  std::set<std::string> seen{file_itself(options.scene)};
  std::vector<std::string> files = options.out;
  if (!options.report.empty()) files.push_back(options.report);
  for (const std::string& file : files) {
    if (file == "/dev/null") continue;
    if (!seen.insert(file_itself(file)).second) {
      Location where;
      where.file = file;
      throw Error(where, "is named twice", "give every file a name of its own");
    }
  }
}

std::string summary(const RunOptions& options, const World& world, const RunReport& report) {
  char text[160];
  std::snprintf(text, sizeof text, "%lld frames, %.3g ms a frame (95%%: %.3g), %d threads, %s",
                static_cast<long long>(world.state().frame), report.median_milliseconds(), report.p95_milliseconds(),
                world.threads(), world.isa().c_str());
  return one_line(options.scene) + ": " + text + "\nstate " + world.state_hash() + "\n";
}

}  // namespace

int run(const RunOptions& options) {
  refuse_same_file_twice(options);
  const Scene scene = read_scene_with(options.scene, options.overrides);
  World world(scene);

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
  if (!options.quiet) print(summary(options, world, report));
  return 0;
}

}  // namespace pliant::command
