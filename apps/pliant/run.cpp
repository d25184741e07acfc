// pliant run: simulates a scene, and writes what was asked for.
//
// Everything that can be refused is refused before the first frame: the formats and places of all files, and the report's
// own.
#include <cstdint>
#include <memory>

#include "apps/compare/compare.h"
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
  const std::int64_t frames = world.state().frame;
  const std::string times = compare::figure(report.median_milliseconds(), 3) +
                            " ms a frame (95%: " + compare::figure(report.p95_milliseconds(), 3) + "), ";
  return one_line(options.scene) + ": " + counted(static_cast<std::size_t>(frames), "frame") + ", " +
         (frames > 0 ? times : "") + counted(static_cast<std::size_t>(world.threads()), "thread") + ", " + world.isa() +
         "\nstate " + world.state_hash() + "\n";
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
    for (const auto& writer : writers) print_written(writer->written());
    if (report_file) print_written({{report_file->path(), report_file->size()}});
  }
  return 0;
}

}  // namespace pliant::command
