#include "checkpoint.h"

#include <algorithm>
#include <utility>

#include "apps/command_line/simulate.h"
#include "pliant/edit.h"

namespace pliant::command {

namespace {

bool anything_comes_apart(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), comes_apart);
}

}  // namespace

Checkpoint::Checkpoint(std::string path, int every, const Scene& scene) : path_(std::move(path)), every_(every) {
  if (path_.empty()) return;
  fingerprint_ = fingerprint(scene);
  comes_apart_ = anything_comes_apart(scene);
  if (comes_apart_) scene_ = scene;
}

void Checkpoint::begin(World& world) {
  if (!path_.empty()) last_ = world.state();
}

void Checkpoint::after_frame(World& world) {
  if (path_.empty()) return;
  last_ = world.state();
  if (last_.frame % every_ == 0) write_last(world);
}

void Checkpoint::write_last(World& world) {
  if (path_.empty() || last_.frame == saved_) return;
  if (comes_apart_) {
    // Objects come apart at the ends of frames alone, so the State of the last one fits.
    if (world.state().time != last_.time) world.restore(last_);
    save(path_, world, present_scene(world, scene_), fingerprint_);
  } else {
    save(path_, last_, fingerprint_);
  }
  saved_ = last_.frame;
}

Resumed resume(const std::string& path, const Scene& scene, const std::string& scene_path) {
  if (anything_comes_apart(scene)) {
    LoadedWorld loaded = load_world(path, fingerprint(scene), scene.settings);
    return {std::move(loaded.world), std::move(loaded.scene)};
  }
  Resumed resumed{make_world(scene, scene_path), {}};
  resumed.world.restore(load_state(path, scene));
  return resumed;
}

}  // namespace pliant::command
