// What run and render share: reading a scene with changes of the command line, and the loop over frames.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "apps/command_line/overrides.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::command {

/// Adds "pointer=value" texts to the options. Throws an Error if one has no '='.
void add_values(const std::vector<std::string>& values, SceneReadOptions& options);

/// Reads a scene file and applies the changes to its scene. Prints the repairs of its meshes unless `quiet`.
SceneFile read_file_with(const std::string& path, const Overrides& overrides, bool quiet);
/// Does the same, and returns the scene alone.
Scene read_scene_with(const std::string& path, const Overrides& overrides, bool quiet);

/// Makes the World of a scene that was read from `path`, which errors name.
World make_world(const Scene& scene, const std::string& path);

/// Adds the path to an error, unless it names a file already.
Error of_file(const Error& error, const std::string& path);

/// Steps a World until it has made all frames of the scene, and calls `after_frame` after each. Returns false after a
/// frame that is not finite. Shows progress on a terminal unless `quiet`. Throws Interrupted after a termination
/// signal.
bool simulate(World& world, const Scene& scene, bool quiet, const std::function<void(const Report&)>& after_frame);

/// Throws an Error if the scene has fewer frames than `frame`.
void require_frame(const Scene& scene, const std::string& path, int frame);

/// Throws an Error if the World of the scene tears or cuts an object, which `who` cannot follow.
void refuse_tears(const Scene& scene, const std::string& path, const std::string& who);

/// True if `path` ends with `suffix` (".png"), in upper or lower case.
bool has_suffix(const std::string& path, std::string_view suffix);

/// Simulates as simulate() does, but if a frame is not finite it throws an Error with the report's message.
void simulate_finite(World& world, const Scene& scene, const std::string& path, bool quiet,
                     const std::function<void()>& after_frame);

}  // namespace pliant::command
