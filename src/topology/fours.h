// Groups of four constraints whose particles are contiguous in memory in some slots.
#pragma once

#include <array>
#include <vector>

namespace pliant {

/// Four constraints that share no particle. In each slot whose bit is set in `runs`, the particle of member l is that of
/// the first member plus l, and the latter is a multiple of four.
struct Four {
  int runs = 0;
  std::array<int, 4> members{};
};

/// Takes groups of four out of `members` (stencils of `size` particles each, at stencils[size * member]): those with most
/// contiguous slots first, down to one. Ungrouped constraints remain in their order.
std::vector<Four> take_fours(const std::vector<int>& stencils, int size, std::vector<int>& members);

}  // namespace pliant
