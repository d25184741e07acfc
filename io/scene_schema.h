// Writes the table of scene_grammar as JSON Schema for editors, and as Markdown for people.
#pragma once

#include <string>

namespace pliant::scene_file {

/// The reference of every record and field in Markdown. docs/reference/scene-format.md contains it between two marks,
/// and a test compares both.
std::string scene_reference();

/// The JSON Schema (2020-12) as text.
std::string schema_text();

}  // namespace pliant::scene_file
