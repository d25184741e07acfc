// Suggests a name for an unknown member.
#pragma once

#include <string>
#include <vector>

#include "scene_grammar.h"

namespace pliant::scene_file {

/// The number of insertions, deletions, substitutions and swaps of adjacent characters that change `a` into `b`
/// (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The name that is most similar to `wanted`, of equal ones the first; up to a third of its letters may differ. If
/// there is none, the first name that contains `wanted`; else empty.
std::string nearest_name(const std::string& wanted, const std::vector<std::string>& names);

/// Advice for a member `wanted` that `record` does not have: a name of the record that is similar in spelling or
/// meaning; a record that has the name, or a similar one, below it or of those that a scene has once
/// ("settings.substeps"); or all names of the record.
std::string hint_for(const std::string& wanted, const Record& record);

}  // namespace pliant::scene_file
