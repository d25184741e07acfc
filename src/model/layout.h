// A model whose objects came and went, made anew.
#pragma once

#include <vector>

#include "model/model.h"

namespace pliant {

/// Where one number's object stands. Nothing where there is none.
struct ObjectPlace {
  int first = 0, first_frame = 0, generation = 0;
  bool is_free = true;
};

/// Fills a model without objects: number i gets objects[i] at places[i]. Throws Error where two objects overlap.
void lay_out(std::vector<CompiledObject> objects, const std::vector<ObjectPlace>& places, Model& model);

}  // namespace pliant
