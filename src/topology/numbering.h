// Numbering particles so that constraints of one colour use particles that follow one another in memory.
#pragma once

#include <vector>

namespace pliant {

/// The order in which particles are stored: order[new] = old. Tile after tile; inside a tile the particles are cut into lines, runs
/// of consecutive old numbers i, i + 1 with linked_to_next[i], and every line is stored evens first, then odds.
///
/// Why: constraints that share no particle skip every other one along a line. In a grid numbered row by row, the edges
/// (0,1), (2,3), (4,5), (6,7) of a row become (e, o), (e+1, o+1), ...: four neighbours in a run, one load for four records.
std::vector<int> number_in_chains(const std::vector<int>& tile, const std::vector<char>& linked_to_next);

}  // namespace pliant
