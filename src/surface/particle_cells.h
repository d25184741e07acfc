// Particles sorted into cells of twice the spacing, of which only those with particles exist.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "parallel/executor.h"
#include "surface/grid_key.h"
#include "surface/splat.h"

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
  std::vector<float> x, y, z;       ///< the same, and sixteen zeros, for lanes
  std::vector<std::uint64_t> keys;  ///< of the cells, ascending
  std::vector<int> first;           ///< of each cell's particles; one more entry than cells
  std::vector<Fill> fills;          ///< of each cell
  KeyTable table;                   ///< from keys to cells

  int size() const { return static_cast<int>(keys.size()); }
  std::span<const Vec3f> particles(int cell) const {
    return {positions.data() + first[static_cast<std::size_t>(cell)],
            positions.data() + first[static_cast<std::size_t>(cell) + 1]};
  }
  PlaceRows<const float> places() const { return {x.data(), y.data(), z.data()}; }
  /// The cell at these coordinates, or -1.
  int find(const Cell& cell) const { return table.find(key_of(cell)); }
};

ParticleCells sort_into_cells(std::span<const Vec3f> positions, float spacing, Executor& executor);

/// Cells [first, last) that lie side by side along x, at most three.
struct CellRow {
  int first, last;
};

/// Finds the cells around a cell, and itself, for cells in ascending order.
class CellsAround {
 public:
  /// Starts at a cell.
  CellsAround(const ParticleCells& cells, int cell);
  /// The rows of cells around a cell that is not below that of the last call, by z and y.
  std::array<CellRow, 9> of(int cell);

 private:
  const ParticleCells& cells_;
  std::array<KeyFollower, 9> rows_;
};

}  // namespace pliant::surface
