// What a scene's handle refers to.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "handles.h"
#include "pliant/io.h"

namespace pliant::c {

/// A scene, and where it came from, so that it can be read again with other values.
struct SceneHandle {
  Scene scene;
  std::vector<std::string> notes;  ///< repairs of meshes, and what fills left out
  std::string folder = ".";        ///< of the paths in it
  /// Reads the scene with these options; empty if it is no scene file.
  std::function<SceneFile(const SceneReadOptions&)> source{};
  SceneReadOptions options{};  ///< arrays and values of all calls so far
  std::vector<ForceField> forces{};
  std::vector<Finding> findings{};  ///< of the last check
};

/// Reads it again; all else stays. Throws an Error if that fails, and then changes nothing.
void read_again(SceneHandle& scene);

}  // namespace pliant::c
