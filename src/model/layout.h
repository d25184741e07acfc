// Rebuilds a Model in which objects were added and removed, as a saved World needs.
#pragma once

#include <vector>

#include "model/model.h"

namespace pliant {

/// The blocks and the generation of one object number; `is_free`: no object has the number.
struct ObjectPlace {
  int first = 0, first_frame = 0, generation = 0;
  bool is_free = true;
};

/// Fills an empty model: objects[i] gets number i and the block places[i]. Throws an Error if two blocks overlap.
void lay_out(std::vector<CompiledObject> objects, const std::vector<ObjectPlace>& places, Model& model);

}  // namespace pliant
