// Particles sorted into cells of twice the spacing, of which only those with particles exist.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "parallel/executor.h"
#include "surface/grid_key.h"

namespace pliant::surface {

/// How much liquid there is about a cell.
enum class Fill : char {
  sparse,    ///< the cell may contain surface
  full,      ///< the cell has about as many particles as at rest
  enclosed,  ///< so have all its 26 neighbours, so its particles have neighbours on all sides
};

struct ParticleCells {
  float side = 0;                   ///< of a cell [m]
  std::vector<Vec3f> positions;     ///< by cells, within a cell in the order given
  std::vector<std::uint64_t> keys;  ///< of the cells, ascending
  std::vector<int> first;           ///< of each cell's particles; one more entry than cells
  std::vector<Fill> fills;          ///< of each cell
  KeyTable table;                   ///< from keys to cells

  int size() const { return static_cast<int>(keys.size()); }
  std::span<const Vec3f> particles(int cell) const {
    return {positions.data() + first[static_cast<std::size_t>(cell)],
            positions.data() + first[static_cast<std::size_t>(cell) + 1]};
  }
  /// The cell at these coordinates, or -1.
  int find(const Cell& cell) const { return table.find(key_of(cell)); }
};

ParticleCells sort_into_cells(std::span<const Vec3f> positions, float spacing, Executor& executor);

/// A cell and its neighbours, by z, y and x; -1 where there is none.
std::array<int, 27> cells_around(const ParticleCells& cells, int cell);

}  // namespace pliant::surface
