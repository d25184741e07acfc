// Arrays of the caller's as meshes and points of the scene format.
#pragma once

#include "errors.h"
#include "pliant/io.h"

namespace pliant::c {

/// Copies arrays. Throws a StatusError for null pointers, wrong sizes, numbers of corners that do not exist, and for a
/// name that occurs twice.
SceneArrays arrays_of(const pliant_array* arrays, size_t count);

/// Adds arrays to others, and returns the names of those that were not there. Throws a StatusError if a name is taken
/// by another array; then nothing is added.
std::vector<std::string> add_arrays(SceneArrays& to, SceneArrays&& from);
void remove_arrays(SceneArrays& from, const std::vector<std::string>& names);

}  // namespace pliant::c
