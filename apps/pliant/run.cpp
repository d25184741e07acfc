// pliant run: simulates a scene and writes the requested files.
//
// All checks are made before the first frame, among them those of the formats and paths of all files.
#include <cstdint>
#include <functional>
#include <memory>

#include "apps/command_line/figure.h"
#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"
#include "apps/command_line/simulate.h"
#include "atomic_file.h"
#include "checkpoint.h"
#include "command.h"
#include "gauge_table.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "run_report.h"

namespace pliant::command {

namespace {

std::string summary(const RunOptions& options, const World& world, const RunReport& report) {
  const std::int64_t frames = world.state().frame;
  const std::string times =
      figure(report.median_milliseconds(), 3) + " ms a frame (95%: " + figure(report.p95_milliseconds(), 3) + "), ";
  return one_line(options.scene) + ": " + counted(static_cast<std::size_t>(frames), "frame") + ", " +
         (report.frames() > 0 ? times : "") + counted(static_cast<std::size_t>(world.threads()), "thread") + ", " +
         world.isa() + "\nstate " + world.state_hash() + "\n";
}

/// What tore, was cut or broke, as a line; empty if nothing did.
std::string summary(const Tears& tears) {
  if (tears.first_frame < 0) return {};
  const std::string joints =
      tears.broken_joints == 0 ? "" : ", " + counted(static_cast<std::size_t>(tears.broken_joints), "broken joint");
  return "tears: " + counted(static_cast<std::size_t>(tears.lost_constraints), "constraint") + " lost and " +
         counted(static_cast<std::size_t>(tears.new_particles), "new particle") + joints + ", the first in frame " +
         std::to_string(tears.first_frame) + "\n";
}

/// What emitters did not emit, as a line; empty if they emitted all.
std::string summary(const FlowReport& flow) {
  if (flow.refused == 0) return {};
  return "emitters: " + counted(static_cast<std::size_t>(flow.refused), "particle") +
         " refused, because as many were there as the capacity allows\n";
}

/// Throws an Error for files that cannot be written, or that would overwrite one another.
void check_files(const RunOptions& options) {
  std::vector<std::string> files = options.out;
  for (const std::string& file : {options.report, options.gauges, options.checkpoint})
    if (!file.empty()) files.push_back(file);
  refuse_same_file_twice({options.scene}, files);
  // The file that the run resumes from may be overwritten only by the checkpoint.
  if (!options.resume.empty() && options.resume != options.checkpoint)
    refuse_same_file_twice({options.scene, options.resume}, files);
  for (const std::string& file : files) refuse_unwritable(file);
}

/// The World at the start of the run, or at its checkpoint.
Resumed start_of(const RunOptions& options, const Scene& scene) {
  if (options.resume.empty()) return {make_world(scene, options.scene), {}};
  try {
    Resumed resumed = resume(options.resume, scene, options.scene);
    const std::int64_t frame = resumed.world.state().frame;
    if (frame <= scene.frames) return resumed;
    throw Error({},
                "is of frame " + std::to_string(frame) + ", beyond the " +
                    counted(static_cast<std::size_t>(scene.frames), "frame") + " to be simulated",
                "set --frames to a larger number");
  } catch (const Error& error) {
    throw of_file(error, options.resume);
  }
}

/// Simulates to the end. After a signal the checkpoint has the last complete frame.
bool simulate_with(Checkpoint& checkpoint, World& world, const Scene& scene, bool quiet,
                   const std::function<void(const Report&)>& after_frame) {
  checkpoint.begin(world);
  try {
    return simulate(world, scene, quiet, [&](const Report& frame) {
      after_frame(frame);
      if (frame.ok()) checkpoint.after_frame(world);
    });
  } catch (const Interrupted&) {
    checkpoint.write_last(world);
    throw;
  }
}

}  // namespace

int run(const RunOptions& options) {
  check_files(options);
  const SceneFile file = read_file_with(options.scene, options.overrides, options.quiet);
  const Scene& scene = file.scene;
  Resumed start = start_of(options, scene);
  World& world = start.world;
  for (const std::string& path : options.out) make_folder_of(path);
  for (const std::string& path : {options.report, options.gauges, options.checkpoint}) make_folder_of(path);

  std::vector<std::unique_ptr<FrameWriter>> writers;
  for (const std::string& path : options.out)
    writers.push_back(
        make_frame_writer(path, start.contents ? *start.contents : scene, world, {options.liquid_surfaces}));
  GaugeTable gauges(options.gauges, file, world);
  std::unique_ptr<AtomicFile> report_file;
  if (!options.report.empty()) report_file = std::make_unique<AtomicFile>(options.report);

  RunReport report(options.hash_frames);
  Checkpoint checkpoint(options.checkpoint, options.every, scene);
  for (const auto& writer : writers) writer->add(world);
  gauges.add(world);
  const bool finite = simulate_with(checkpoint, world, scene, options.quiet, [&](const Report& frame) {
    report.add(frame, world);
    if (!frame.ok()) return;
    for (const auto& writer : writers) writer->add(world);
    gauges.add(world);
  });

  // If a run became infinite, its report, which says where, is written, but no geometry.
  if (finite) {
    for (const auto& writer : writers) writer->finish();
    gauges.finish();
    checkpoint.write_last(world);
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
    for (const std::string& warning : report.warnings(world)) print("warning: " + one_line(warning) + "\n");
    if (const std::string advice = report.advice(world); !advice.empty()) print("warning: " + one_line(advice) + "\n");
    print(summary(options, world, report) + summary(report.tears()) + summary(report.flow()));
    for (const auto& writer : writers) print_written(writer->written());
    print_written(gauges.written());
    if (report_file) print_written({{report_file->path(), report_file->size()}});
  }
  return 0;
}

}  // namespace pliant::command
