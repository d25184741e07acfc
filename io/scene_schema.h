// Exports the table of scene_grammar: JSON Schema for editors, Markdown for people.
#pragma once

#include <string>

namespace pliant::scene_file {

/// The Markdown reference of every record and field. docs/reference/scene-format.md
/// contains it between two marks, and a test compares them.
std::string scene_reference();

/// The JSON Schema (2020-12), as text.
std::string schema_text();

}  // namespace pliant::scene_file
