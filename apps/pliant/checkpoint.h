// Checkpoints of a run: files from which a run continues with the same bits. They have its State, or where objects come
// apart, and a State does not fit the scene any more, its World.
#pragma once

#include <cstdint>
#include <optional>
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
  void begin(World& world);
  /// Notes the State, and saves it if due; call it after each complete frame.
  void after_frame(World& world);
  /// Saves the last complete frame, unless that is in the file already. A World within a frame returns to that frame.
  void write_last(World& world);

 private:
  std::string path_;
  int every_;
  Scene scene_;  ///< that the World was made from, if its objects come apart
  bool comes_apart_ = false;
  Fingerprint fingerprint_;
  State last_;               ///< State after the last complete frame
  std::int64_t saved_ = -1;  ///< frame number of the State in the file; -1: none
};

/// The World of a checkpoint, and its contents where objects may have come apart.
struct Resumed {
  World world;
  std::optional<Scene> contents;
};
/// `scene_path` names the scene in errors.
Resumed resume(const std::string& path, const Scene& scene, const std::string& scene_path);

}  // namespace pliant::command
