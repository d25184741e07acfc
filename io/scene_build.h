// From a checked JSON tree to a Scene.
#pragma once

#include "pliant/io.h"
#include "scene_json.h"
#include "scene_mesh.h"

namespace pliant::scene_file {

/// Builds the scene of a document that passed check() with scene_record(). Throws Error where values contradict each other,
/// a mesh can't be read or can't be cloth, a particle doesn't exist, or a selection is empty.
SceneFile build(const JsonDocument& document, const MeshFolder& folder);

/// What makes an object's particles, and what selections need to know besides.
struct BuiltObject {
  Object object;
  int columns = 0, rows = 0;  ///< of a grid, else 0
};

/// The object without its pins and attachments. `what` is the member "cloth", "rope" or "particles".
BuiltObject build_matter(const JsonDocument& document, const JsonValue& what, const std::string& name,
                         const MeshFolder& folder, std::vector<std::string>& repairs);

/// The particles that a checked selection stands for, each once.
std::vector<int> selected(const JsonDocument& document, const JsonValue& at, const BuiltObject& built);

}  // namespace pliant::scene_file
