// The table of scene_grammar in two other languages: JSON Schema for editors, Markdown for people.
#pragma once

#include <string>

namespace pliant::scene_file {

/// The reference of every record and field in Markdown; docs/reference/scene-format.md holds it between two marks, and a test
/// compares.
std::string scene_reference();

/// The JSON Schema (2020-12), as text.
std::string schema_text();

}  // namespace pliant::scene_file
