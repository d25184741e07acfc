// The scratch data of the limit of overstretch (stages/limit.cpp).
#pragma once

#include <vector>

#include "solver/lengths.h"

namespace pliant {

/// Two particles that a distance constraint joins, numbered over all objects, the greatest distance they may have, and
/// the distance beyond which they are limited in further rounds [m].
struct LimitedLength {
  int from = 0, to = 0;
  float longest = 0, tolerated = 0;
};

struct LimitScratch {
  std::vector<std::vector<FoundLength>> found;  ///< by task
  std::vector<char> is_searched;                ///< for each object, 1 if its constraints are searched in this round
  std::vector<char> is_moved;                   ///< for each object, 1 if constraints of it are shortened
  std::vector<LimitedLength> limited;           ///< of all tasks, in their order
};

}  // namespace pliant
