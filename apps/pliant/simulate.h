// The common part of run and render: a scene with the caller's overrides, and the frame loop.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "command.h"
#include "pliant/error.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::command {

/// Reads a scene and applies the overrides. Prints the repairs of its meshes unless `quiet`.
Scene read_scene_with(const std::string& path, const Overrides& overrides, bool quiet);

/// Makes the World of a scene read from `path`; errors name the file.
World make_world(const Scene& scene, const std::string& path);

/// The same error located in the file, unless it names one already.
Error of_file(const Error& error, const std::string& path);

/// Steps until the World has made all of the scene's frames and calls `after_frame` after each. Returns false after a frame
/// that is not finite. Shows progress on a terminal unless `quiet`. Throws Interrupted on a termination signal.
bool simulate(World& world, const Scene& scene, bool quiet, const std::function<void(const Report&)>& after_frame);

/// Throws an Error if the scene has fewer frames.
void require_frame(const Scene& scene, const std::string& path, int frame);

/// True if `path` ends in `suffix` (".png"), case-insensitively.
bool has_suffix(const std::string& path, std::string_view suffix);

/// Simulates like simulate(), but throws an Error with the report's message if a frame is not finite.
void simulate_finite(World& world, const Scene& scene, const std::string& path, bool quiet,
                     const std::function<void()>& after_frame);

}  // namespace pliant::command
