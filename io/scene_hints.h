// What a name that is not known may have been meant for.
#pragma once

#include <string>
#include <vector>

#include "scene_grammar.h"

namespace pliant::scene_file {

/// The number of single-character insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`
/// (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The name most like `wanted`, the first of several: a third of its letters may differ. Without one, the first that contains it.
/// Nothing where none is near.
std::string nearest_name(const std::string& wanted, const std::vector<std::string>& names);

/// What to do about a member `wanted` that is none of `record`: a name like it that the record has, a record that has the name,
/// a name like it elsewhere, with the way there ("settings.substeps"), or else all names of the record.
std::string hint_for(const std::string& wanted, const Record& record);

}  // namespace pliant::scene_file
