// Checkpoints of a run: files with its State, from which a run continues with the same bits.
#pragma once

#include <cstdint>
#include <string>

#include "pliant/save.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::command {

class Checkpoint {
 public:
  /// Saves to `path` after every `every`-th frame; an empty path saves nothing.
  Checkpoint(std::string path, int every, const Scene& scene);

  /// Notes the State at the start; call it before the first frame.
  void begin(const World& world);
  /// Notes the State, and saves it if due; call it after each complete frame.
  void after_frame(const World& world);
  /// Saves the last complete frame, unless that is in the file already.
  void write_last();

 private:
  std::string path_;
  int every_;
  Fingerprint fingerprint_;
  State last_;               ///< State after the last complete frame
  std::int64_t saved_ = -1;  ///< frame number of the State in the file; -1: none
};

}  // namespace pliant::command
