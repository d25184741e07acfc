// Recreates a model after additions and removals.
#pragma once

#include <vector>

#include "model/model.h"

namespace pliant {

/// The position of one number's object, or none.
struct ObjectPlace {
  int first = 0, first_frame = 0, generation = 0;
  bool is_free = true;
};

/// Fills an empty model: number i gets objects[i] at places[i]. Throws an Error if two objects overlap.
void lay_out(std::vector<CompiledObject> objects, const std::vector<ObjectPlace>& places, Model& model);

}  // namespace pliant
