// Parts of surfaces: connected components of an object, and whole mesh colliders. Two skirts in one file are two parts.
#pragma once

#include <vector>

#include "collision/proxies/pair_model.h"

namespace pliant {

struct Parts {
  std::vector<int> of;  ///< part of each vertex; parts are numbered by their first vertices
  int count = 0;
};

Parts find_parts(const PairModel& model);

}  // namespace pliant
