// Checkpoints of a run: a file with its State, from which it resumes with the same bits.
#pragma once

#include <cstdint>
#include <string>

#include "pliant/save.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::command {

class Checkpoint {
 public:
  /// Saves to `path` after every `every`-th frame; does nothing if `path` is empty.
  Checkpoint(std::string path, int every, const Scene& scene);

  /// Call before the first frame.
  void begin(const World& world);
  /// Call after each complete frame.
  void after_frame(const World& world);
  /// Saves the last complete frame unless it has been saved.
  void write_last();

 private:
  std::string path_;
  int every_;
  Fingerprint fingerprint_;
  State last_;               ///< the State after the last complete frame
  std::int64_t saved_ = -1;  ///< the frame in the file; -1: none
};

}  // namespace pliant::command
