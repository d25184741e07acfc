// What the command line changes in a scene.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pliant::command {

/// Changes of a scene, for subcommands that simulate.
struct Overrides {
  std::optional<int> frames, threads, substeps, iterations;
  std::string sweep;                ///< name of a sweep, with options: "chains+tethers"; empty: the scene's own
  std::string isa;                  ///< instruction set level; empty: the best that the machine has
  bool sequential = false;          ///< use scalar code
  std::vector<std::string> meshes;  ///< "name=path": mesh files of objects and colliders
  std::vector<std::string> values;  ///< "pointer=value": members of the scene to set, by JSON pointer
  std::string cache;                ///< folder of cached distance grids; empty: no cache
};

}  // namespace pliant::command
