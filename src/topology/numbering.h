// Storage order in which constraints of one colour use contiguous particles.
#pragma once

#include <vector>

namespace pliant {

/// Returns the storage order: order[new] = old, tile after tile. A tile is cut into lines, which are ranges of consecutive
/// old numbers i, i + 1 with linked_to_next[i]. Each line is stored with its even elements first, then its odd ones.
///
/// Why: constraints that share no particle use every other one along a line. In a grid numbered by rows, the edges (0,1),
/// (2,3), (4,5), (6,7) become (e, o), (e+1, o+1), ...: a contiguous group, where one load fetches four records.
std::vector<int> number_in_chains(const std::vector<int>& tile, const std::vector<char>& linked_to_next);

}  // namespace pliant
