// Whether a text says what a scene may say, before anything is built from it.
#pragma once

#include <string>

#include "scene_grammar.h"
#include "scene_json.h"

namespace pliant::scene_file {

/// Throws Error at the first unknown, repeated or missing member, wrong type, or number out of range.
void check(const JsonDocument& document, const Record& record);

/// Throws Error at the first member that nobody asked for by JsonValue::find: nothing that a file says is dropped in
/// silence.
void check_all_used(const JsonDocument& document);

}  // namespace pliant::scene_file
