// Storage order in which constraints of one colour use contiguous particles.
#pragma once

#include <vector>

namespace pliant {

/// Returns the storage order: order[new] = old, tile after tile. A tile is divided into lines: ranges of old indices
/// with linked_to_next[i] for each i but the last. Of a line, even elements are stored first, then odd ones.
///
/// Reason: along a line, every other constraint can be projected at once. In a grid numbered by rows, the edges (0,1),
/// (2,3), (4,5), (6,7) become (e, o), (e+1, o+1), ...: a contiguous group, which one load fetches.
std::vector<int> number_in_chains(const std::vector<int>& tile, const std::vector<char>& linked_to_next);

}  // namespace pliant
