// The scratch data of the limit of overstretch (stages/limit.cpp).
#pragma once

#include <vector>

#include "solver/lengths.h"

namespace pliant {

/// Two particles that a distance constraint joins, numbered over all objects, and the greatest distance they may have [m].
struct LimitedLength {
  int from = 0, to = 0;
  float longest = 0;
};

struct LimitScratch {
  std::vector<std::vector<FoundLength>> found;  ///< by task
  std::vector<char> is_moved;                   ///< for each object, 1 if constraints of it are shortened
  std::vector<LimitedLength> limited;           ///< of all tasks, in their order
};

}  // namespace pliant
