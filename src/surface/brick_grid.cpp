// Finds the blocks above each block.
#include "surface/brick_grid.h"

#include "parallel/ranges.h"

namespace pliant::surface {

namespace {

/// The step in keys to the row of blocks one up along y (bit 0) and z (bit 1).
std::uint64_t step_to_block_row(int row) { return key_step(0, row & 1, row >> 1); }

}  // namespace

std::vector<Neighbours> find_neighbours(const Field& field, Executor& executor) {
  constexpr int blocks_at_a_time = 256;
  std::vector<Neighbours> found(field.keys.size());
  const auto key_at = [&](int block) { return field.keys[static_cast<std::size_t>(block)]; };
  for_ranges(executor, "surface: neighbours", field.size(), blocks_at_a_time, [&](int first, int last) {
    std::array<KeyFollower, 4> rows;
    for (int row = 0; row < 4; ++row)
      rows[static_cast<std::size_t>(row)] = KeyFollower(field.keys, key_at(first) + step_to_block_row(row));
    for (int block = first; block < last; ++block)
      for (int row = 0; row < 4; ++row) {
        const std::uint64_t key = key_at(block) + step_to_block_row(row);
        int at = rows[static_cast<std::size_t>(row)].first_from(key);
        for (int x = 0; x < 2; ++x) {
          const bool is_there = at < field.size() && key_at(at) == key + static_cast<std::uint64_t>(x);
          const int slot = 2 * row + x;
          found[static_cast<std::size_t>(block)][static_cast<std::size_t>(slot)] = is_there ? at++ : -1;
        }
      }
  });
  return found;
}

BrickGrid bricks_above(const Neighbours& neighbours) {
  BrickGrid grid{};
  std::size_t n = 0;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) {
        const int block = neighbours[static_cast<std::size_t>(x >> 1 | (y >> 1) << 1 | (z >> 1) << 2)];
        grid[n++] = block < 0 ? -1 : block_bricks * block + ((x & 1) | (y & 1) << 1 | (z & 1) << 2);
      }
  return grid;
}

}  // namespace pliant::surface
