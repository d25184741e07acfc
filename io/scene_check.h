// Checks a JSON tree against the scene format, before anything is built from it.
#pragma once

#include <string>

#include "scene_grammar.h"
#include "scene_json.h"

namespace pliant::scene_file {

/// Throws an Error at the first unknown, repeated or missing member, wrong type, or number out of range.
void check(const JsonDocument& document, const Record& record);

/// Throws an Error at the first member that no reader asked for (JsonValue::find), so that no content of a file is
/// silently ignored.
void check_all_used(const JsonDocument& document);

}  // namespace pliant::scene_file
