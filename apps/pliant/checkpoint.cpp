#include "checkpoint.h"

#include <utility>

namespace pliant::command {

Checkpoint::Checkpoint(std::string path, int every, const Scene& scene) : path_(std::move(path)), every_(every) {
  if (!path_.empty()) fingerprint_ = fingerprint(scene);
}

void Checkpoint::begin(const World& world) {
  if (!path_.empty()) last_ = world.state();
}

void Checkpoint::after_frame(const World& world) {
  if (path_.empty()) return;
  last_ = world.state();
  if (last_.frame % every_ == 0) write_last();
}

void Checkpoint::write_last() {
  if (path_.empty() || last_.frame == saved_) return;
  save(path_, last_, fingerprint_);
  saved_ = last_.frame;
}

}  // namespace pliant::command
