// pliant compare: one scene with several sweeps, as a table, a picture and JSON.
#include "apps/compare/compare.h"

#include <memory>

#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"
#include "apps/command_line/simulate.h"
#include "apps/measure/measure.h"
#include "apps/plot/canvas.h"
#include "atomic_file.h"
#include "pliant/error.h"

namespace pliant::command {

namespace {

/// The output files. They are opened before any measurement, so that a path that cannot be written fails at once.
struct Outputs {
  std::unique_ptr<AtomicFile> json;
  std::string picture;
};

Outputs open_outputs(const std::vector<std::string>& paths) {
  Outputs outputs;
  for (const std::string& path : paths) {
    Location where;
    where.file = path;
    const bool is_json = has_suffix(path, ".json"), is_picture = has_suffix(path, ".png");
    if (!is_json && !is_picture) throw Error(where, "is neither .png nor .json", "name a picture or a JSON file");
    if (is_json ? outputs.json != nullptr : !outputs.picture.empty())
      throw Error(where, "is a second file of its kind", "name at most one picture and one JSON file");
    if (is_json) outputs.json = std::make_unique<AtomicFile>(path);
    if (is_picture) outputs.picture = path;
  }
  return outputs;
}

pliant::compare::Options options_of(const CompareOptions& options, const Scene& scene) {
  pliant::compare::Options wanted;
  wanted.methods = options.sweeps;
  wanted.frame = options.frame ? *options.frame : -1;
  wanted.substeps = options.substeps;
  wanted.iterations = options.iterations;
  wanted.budget = options.budget;
  wanted.pause = throw_if_interrupted;
  if (options.budget > 0 && scene.frames == 0)
    throw Error({}, "the scene has no frames, which a budget needs", "set --frames");
  return wanted;
}

pliant::compare::Result measured(const CompareOptions& options, const Scene& scene) {
  const pliant::compare::Options wanted = options_of(options, scene);
  try {
    return pliant::compare::run(scene, wanted);
  } catch (const Error& error) {
    throw of_file(error, options.scene);
  }
}

}  // namespace

int compare(const CompareOptions& options) {
  refuse_same_file_twice({options.scene}, options.out);
  const Scene scene = read_scene_with(options.scene, options.overrides, false);
  refuse_tears(scene, options.scene, "a comparison of sweeps from one State");
  if (options.frame) require_frame(scene, options.scene, *options.frame);
  const Outputs outputs = open_outputs(options.out);
  const pliant::compare::Result result = measured(options, scene);
  print(one_line(options.scene) + " " + pliant::compare::to_table(result));
  for (const auto& refusal : result.refused)
    print("left out: " + refusal.name + ": " + one_line(refusal.reason) + "\n");
  if (outputs.json) {
    outputs.json->write(pliant::compare::to_json(result));
    outputs.json->commit();
  }
  if (!outputs.picture.empty())
    pliant::plot::write_png(outputs.picture, pliant::plot::paint(pliant::compare::to_charts(result)));
  return 0;
}

}  // namespace pliant::command
