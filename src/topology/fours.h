// Groups of four constraints whose particles are contiguous in memory in some slots.
#pragma once

#include <array>
#include <vector>

namespace pliant {

/// The most slots of a constraint that is grouped.
inline constexpr int largest_grouped_stencil = 4;

/// Four constraints that share no particle. In each slot whose bit is set in `runs`, the particles of the four members
/// are a, a + 1, a + 2, a + 3, where a is a multiple of four.
struct Four {
  int runs = 0;
  std::array<int, 4> members{};
};

/// Removes groups of four from `members` and returns them, those with most contiguous slots first. Constraint m has the
/// particles stencils[size * m] to stencils[size * m + size - 1]. Members without a group stay, in their order.
std::vector<Four> take_fours(const std::vector<int>& stencils, int size, std::vector<int>& members);

}  // namespace pliant
