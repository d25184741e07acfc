#include "simulate.h"

#include "interrupt.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "progress.h"

namespace pliant::command {

Scene read_scene_with(const std::string& path, const Overrides& overrides) {
  Scene scene = read_scene(path);
  if (overrides.frames) scene.frames = *overrides.frames;
  Settings& settings = scene.settings;
  if (overrides.threads) settings.threads = *overrides.threads;
  if (overrides.substeps) settings.substeps = *overrides.substeps;
  if (overrides.iterations) settings.iterations = *overrides.iterations;
  if (!overrides.isa.empty()) settings.isa = overrides.isa;
  if (overrides.sequential) settings.sweep = Sweep::sequential;
  return scene;
}

bool simulate(World& world, const Scene& scene, bool quiet, const std::function<void(const Report&)>& after_frame) {
  Progress progress(scene.frames, !quiet);
  for (int frame = 1; frame <= scene.frames; ++frame) {
    throw_if_interrupted();
    const Report report = world.step(scene.frame_time);
    after_frame(report);
    if (!report.ok()) return false;
    progress.show(frame);
  }
  throw_if_interrupted();
  return true;
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
