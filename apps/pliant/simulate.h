// What run and render share: a scene read with the caller's changes, and the loop over its frames.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "command.h"
#include "pliant/error.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::command {

/// Reads a scene and applies what the caller changes of it. Prints what reading its meshes mended, unless `quiet`.
Scene read_scene_with(const std::string& path, const Overrides& overrides, bool quiet);

/// Makes the World of a scene that was read from `path`: what is wrong with it names the file.
World make_world(const Scene& scene, const std::string& path);

/// The same error, of the file unless it names one already.
Error of_file(const Error& error, const std::string& path);

/// Steps until the World has made the scene's frames, from those that it has made, and calls `after_frame` after each. Stops early, and returns false, after a frame that is not
/// finite. Shows progress where standard error is a terminal and not `quiet`. Throws Interrupted on a signal to end.
bool simulate(World& world, const Scene& scene, bool quiet, const std::function<void(const Report&)>& after_frame);

/// Throws Error where the scene has fewer frames than that.
void require_frame(const Scene& scene, const std::string& path, int frame);

/// Whether `path` ends in `suffix` (".png"), capitals or not.
bool has_suffix(const std::string& path, std::string_view suffix);

/// Simulates as simulate() does, and throws Error with the report's own words where a frame is not finite.
void simulate_finite(World& world, const Scene& scene, const std::string& path, bool quiet,
                     const std::function<void()>& after_frame);

}  // namespace pliant::command
