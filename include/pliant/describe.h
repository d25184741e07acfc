// What a Scene, a World or a Report holds, in a few lines for people: for logs, debuggers and consoles.
#pragma once

#include <string>

#include "pliant/report.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {

/// One line about the scene and one for each object and collider, without a newline at the end. Words and numbers may
/// change from version to version: do not parse them.
std::string describe(const Scene& scene);

/// The same about a World: its time, sweep, substeps and threads, and one line for each object.
std::string describe(const World& world);

/// The frame, its time and cost, contacts, the worst overstretch, and all that explain() says.
std::string describe(const Report& report);

}  // namespace pliant
