// The check of bounds of substeps, with which a reader of scenes can name the place of an error in its file.
#pragma once

#include <optional>

#include "pliant/error.h"
#include "pliant/scene.h"

namespace pliant {

/// The error of `least_substeps` and `most_substeps` that leave no number of substeps; empty if they leave one.
/// Substeps that follow the State are multiples of four, as many in each quarter of a frame.
std::optional<Error> error_of_bounds(const Settings& settings);

}  // namespace pliant
