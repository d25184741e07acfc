// Constraints four by four, where some of their particles follow one another in memory.
#pragma once

#include <array>
#include <vector>

namespace pliant {

/// Four constraints that share no particle; in the slots whose bits `runs` has, member l has the first one's particle plus l, and the
/// first one's is a multiple of four.
struct Four {
  int runs = 0;
  std::array<int, 4> members{};
};

/// Takes fours out of `members` (stencils of `size` particles each, at stencils[size * member]): those with most slots in
/// runs first, down to one. What is in none stays, in its order.
std::vector<Four> take_fours(const std::vector<int>& stencils, int size, std::vector<int>& members);

}  // namespace pliant
