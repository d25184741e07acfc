// Divides surfaces into parts: connected components of objects (two skirts in one file are two), and whole mesh
// colliders.
#pragma once

#include <vector>

#include "collision/proxies/pair_model.h"

namespace pliant {

struct Parts {
  std::vector<int> of;  ///< part of each vertex; parts are numbered in the order of their first vertices
  int count = 0;
};

Parts find_parts(const PairModel& model);

}  // namespace pliant
