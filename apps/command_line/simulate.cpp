#include "apps/command_line/simulate.h"

#include <utility>

#include "apps/command_line/give_back.h"
#include "apps/command_line/interrupt.h"
#include "apps/command_line/output.h"
#include "apps/command_line/progress.h"
#include "apps/command_line/sweep_names.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/io.h"

namespace pliant::command {

namespace {

/// Sets the sweep of all objects by a name such as "chains+tethers". Options that the name does not mention stay as the
/// scene has them.
void set_sweep(const std::string& name, Scene& scene) {
  for (Object& object : scene.objects) object.sweep = Sweep::automatic;
  Settings& settings = scene.settings;
  if (name == "automatic") {
    settings.sweep = Sweep::automatic;
    return;
  }
  const Method method = method_of(name, settings.sweep_options);
  settings.sweep = method.sweep;
  settings.sweep_options = method.options;
}

/// Selects scalar code: the sweep `sequential` instead of `tiled`, or the scalar kernels for other sweeps.
void set_plain(Scene& scene) {
  scene.settings = chosen_settings(scene);
  if (scene.settings.sweep == Sweep::tiled)
    scene.settings.sweep = Sweep::sequential;
  else
    scene.settings.isa = "sequential";
}

void add_meshes(const std::vector<std::string>& meshes, SceneReadOptions& options) {
  for (const std::string& one : meshes) {
    const std::size_t sign = one.find('=');
    if (sign == 0 || sign == std::string::npos || sign + 1 == one.size())
      throw Error({}, "'" + one + "' does not name an object and a mesh",
                  "write name=path, such as --mesh body=bunny.obj");
    const bool is_new = options.meshes.emplace(one.substr(0, sign), one.substr(sign + 1)).second;
    if (!is_new) throw Error({}, "'" + one.substr(0, sign) + "' is given two meshes", "give it one");
  }
}

}  // namespace

void add_values(const std::vector<std::string>& values, SceneReadOptions& options) {
  for (const std::string& one : values) {
    const std::size_t sign = one.find('=');
    if (sign == 0 || sign == std::string::npos)
      throw Error({}, "'" + one + "' sets nothing", "write POINTER=VALUE, such as --set /settings/substeps=20");
    options.values.emplace_back(one.substr(0, sign), one.substr(sign + 1));
  }
}

SceneFile read_file_with(const std::string& path, const Overrides& overrides, bool quiet) {
  const GiveBackMemory during;
  SceneReadOptions options;
  add_meshes(overrides.meshes, options);
  add_values(overrides.values, options);
  SceneFile file = read_scene_file(path, options);
  if (!quiet) print_repairs(file.repairs);
  if (!quiet) print_left_out(file.left_out);
  Scene& scene = file.scene;
  if (overrides.frames) scene.frames = *overrides.frames;
  Settings& settings = scene.settings;
  if (!overrides.sweep.empty()) set_sweep(overrides.sweep, scene);
  if (overrides.threads) settings.threads = *overrides.threads;
  if (overrides.substeps) settings.substeps = *overrides.substeps;
  if (overrides.iterations) settings.iterations = *overrides.iterations;
  if (!overrides.isa.empty()) settings.isa = overrides.isa;
  if (overrides.sequential) set_plain(scene);
  if (!overrides.cache.empty()) use_cached_distances(scene, overrides.cache);
  return file;
}

Scene read_scene_with(const std::string& path, const Overrides& overrides, bool quiet) {
  return read_file_with(path, overrides, quiet).scene;
}

Error of_file(const Error& error, const std::string& path) {
  if (!error.where().file.empty()) return error;
  Location where = error.where();
  where.file = path;
  return {where, error.problem(), error.advice()};
}

World make_world(const Scene& scene, const std::string& path) {
  const GiveBackMemory during;
  try {
    return World(scene);
  } catch (const Error& error) {
    throw of_file(error, path);
  }
}

bool simulate(World& world, const Scene& scene, bool quiet, const std::function<void(const Report&)>& after_frame) {
  world.stop_when(&interrupted());
  const auto done = static_cast<int>(world.state().frame);
  Progress progress(scene.frames - done, !quiet);
  for (int frame = done + 1; frame <= scene.frames; ++frame) {
    throw_if_interrupted();
    const Report report = world.step(scene.frame_time);
    throw_if_interrupted();
    after_frame(report);
    if (!report.ok()) return false;
    progress.show(frame - done);
  }
  throw_if_interrupted();
  return true;
}

void require_frame(const Scene& scene, const std::string& path, int frame) {
  if (frame <= scene.frames) return;
  Location where;
  where.file = path;
  throw Error(where,
              "there is no frame " + std::to_string(frame) + ", it has " +
                  counted(static_cast<std::size_t>(scene.frames), "frame"),
              "name one from 0, the start, to " + std::to_string(scene.frames) + ", or raise the scene's \"frames\"");
}

void refuse_tears(const Scene& scene, const std::string& path, const std::string& who) {
  for (const Object& object : scene.objects)
    if (comes_apart(object))
      throw Error({.file = path, .line = 0, .object = object.name},
                  "tears, is cut or has constraints that break, which " + who + " cannot follow",
                  "leave its `tearing`, `cuts` and `break_force` out");
}

bool has_suffix(const std::string& path, std::string_view suffix) {
  if (path.size() < suffix.size()) return false;
  for (std::size_t i = 0; i < suffix.size(); ++i) {
    const char letter = path[path.size() - suffix.size() + i];
    if ((letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter) != suffix[i]) return false;
  }
  return true;
}

void simulate_finite(World& world, const Scene& scene, const std::string& path, bool quiet,
                     const std::function<void()>& after_frame) {
  std::string words;
  const bool finite = simulate(world, scene, quiet, [&](const Report& report) {
    if (report.ok()) return after_frame();
    words = report.explain();
  });
  if (finite) return;
  Location where;
  where.file = path;
  throw Error(where, words);
}

}  // namespace pliant::command
