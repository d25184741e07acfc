// Finds the blocks that kernels reach, and adds the kernels at their nodes.
#include "surface/field.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace pliant::surface {

namespace {

/// Calls visit for all cells of a box of cells.
template <class Visit>
void for_cells(const Cell& low, const Cell& high, const Visit& visit) {
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) visit(Cell{x, y, z});
}

/// The blocks that the kernels of any cell reach, with one grid cell more for rounding and for the cells below a node.
std::vector<std::uint64_t> reached_blocks(const Splats& splats, float cell) {
  const float per_block = 1 / (static_cast<float>(block_side) * cell);
  const Vec3f margin{cell, cell, cell};
  KeyTable table(splats.bounds.size());
  std::vector<std::uint64_t> keys;
  for (const Box& box : splats.bounds)
    for_cells(cell_at(box.low - margin * 2.f, per_block), cell_at(box.high + margin, per_block), [&](const Cell& block) {
      const std::uint64_t key = key_of(block);
      if (table.insert(key)) keys.push_back(key);
    });
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// The box of a block's nodes.
Box box_of(const Cell& block, float cell) {
  const float side = static_cast<float>(block_side) * cell;
  const Vec3f low{static_cast<float>(block.x) * side, static_cast<float>(block.y) * side,
                  static_cast<float>(block.z) * side};
  const float extent = static_cast<float>(block_side - 1) * cell;
  return {low, low + Vec3f{extent, extent, extent}};
}

/// A bit for each row of a block's nodes, by z and y.
using RowSet = std::uint64_t;

/// The rows of a block with a node that is in no enclosed cell of particles. The surface is far from all other rows.
RowSet live_rows(const ParticleCells& cells, const Box& box, float cell) {
  const float per_side = 1 / cells.side;
  const Cell low = cell_at(box.low, per_side), high = cell_at(box.high, per_side);
  const auto is_enclosed = [&](int y, int z) {
    for (int x = low.x; x <= high.x; ++x) {
      const int at = cells.find({x, y, z});
      if (at < 0 || cells.fills[static_cast<std::size_t>(at)] != Fill::enclosed) return false;
    }
    return true;
  };
  RowSet live = 0;
  for (int k = 0; k < block_side; ++k) {
    const int z = floor_of((box.low.z + static_cast<float>(k) * cell) * per_side);
    int y = low.y;
    bool is_live = !is_enclosed(y, z);
    for (int j = 0; j < block_side; ++j) {
      const int own = floor_of((box.low.y + static_cast<float>(j) * cell) * per_side);
      if (own != y) is_live = !is_enclosed(own, z);
      y = own;
      if (is_live) live |= RowSet{1} << (k * block_side + j);
    }
  }
  return live;
}

/// Nodes of a row of eight, from the first that is not below `low` to the last that is not above `high`.
struct NodeRange {
  int first, last;
};

NodeRange nodes_within(float low, float high, float per_cell) {
  const float most = static_cast<float>(block_side);
  const float from = std::clamp(low * per_cell, 0.f, most), to = std::clamp(high * per_cell, -1.f, most - 1);
  return {-floor_of(-from), floor_of(to)};
}

/// The rows in these ranges.
RowSet rows_within(const NodeRange& in_y, const NodeRange& in_z) {
  if (in_y.last < in_y.first || in_z.last < in_z.first) return 0;
  const auto up_to = [](int n) { return n >= block_rows ? ~RowSet{0} : (RowSet{1} << n) - 1; };
  const RowSet of_y = (up_to(in_y.last + 1) & ~up_to(in_y.first)) * 0x0101010101010101U;
  return of_y & up_to((in_z.last + 1) * block_side) & ~up_to(in_z.first * block_side);
}

/// Adds a kernel to some rows of a block. Along a row the kernel's q is a quadratic polynomial of x.
void add_splat(const Splat splat, const Vec3f& low, float cell, RowSet live, BlockValues& values) {
  const Vec3f centre = splat.centre - low;
  const float per_cell = 1 / cell, per_xx = 1 / splat.xx;
  const NodeRange in_y = nodes_within(centre.y - splat.reach.y, centre.y + splat.reach.y, per_cell);
  const NodeRange in_z = nodes_within(centre.z - splat.reach.z, centre.z + splat.reach.z, per_cell);
  std::array<float, block_side> xs, squares;
  for (int i = 0; i < block_side; ++i) {
    const float x = static_cast<float>(i) * cell - centre.x;
    xs[static_cast<std::size_t>(i)] = 2 * x;
    squares[static_cast<std::size_t>(i)] = splat.xx * x * x;
  }
  for (RowSet rows = rows_within(in_y, in_z) & live; rows != 0; rows &= rows - 1) {
    const int at = std::countr_zero(rows), j = at % block_side, k = at / block_side;
    const float z = static_cast<float>(k) * cell - centre.z;
    const float y = static_cast<float>(j) * cell - centre.y;
    const float slope = splat.xy * y + splat.xz * z;
    const float rest = 1 - (splat.yy * y * y + 2 * splat.yz * y * z + splat.zz * z * z);
    if (rest + slope * slope * per_xx <= 0) continue;  // the largest 1 - q of the row
    float* const row = &values[static_cast<std::size_t>(at) * block_side];
    for (std::size_t i = 0; i < block_side; ++i) {
      const float inside = (rest - squares[i]) - slope * xs[i];
      const float t = inside > 0 ? inside : 0.f;
      row[i] += splat.weight * (t * t * t);
    }
  }
}

bool overlap(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y && a.low.z <= b.high.z &&
         b.low.z <= a.high.z;
}

/// The sum of all kernels at the nodes of a block's live rows, in the order of the particles' cells; 1 at the others.
void evaluate(const ParticleCells& cells, const Splats& splats, const Box& box, float cell, RowSet live,
              BlockValues& values) {
  for (int i = 0; i < block_side * block_rows; ++i)
    values[static_cast<std::size_t>(i)] = (live >> (i / block_side) & 1U) != 0 ? 0.f : 1.f;
  const Vec3f margin{splats.reach, splats.reach, splats.reach};
  const float per_side = 1 / cells.side;
  for_cells(cell_at(box.low - margin, per_side), cell_at(box.high + margin, per_side), [&](const Cell& at) {
    const int c = cells.find(at);
    if (c < 0 || !overlap(splats.bounds[static_cast<std::size_t>(c)], box)) return;
    for (int i = cells.first[static_cast<std::size_t>(c)]; i < cells.first[static_cast<std::size_t>(c) + 1]; ++i) {
      const Splat& splat = splats.all[static_cast<std::size_t>(i)];
      if (overlap({splat.centre - splat.reach, splat.centre + splat.reach}, box))
        add_splat(splat, box.low, cell, live, values);
    }
  });
}

/// Gives storage to the blocks that have live rows, and returns the live rows of all.
std::vector<RowSet> store_blocks(Field& field, const ParticleCells& cells, Executor& executor) {
  std::vector<RowSet> live(field.keys.size());
  executor.parallel_for("surface: blocks", field.size(), [&](int block) {
    const std::size_t b = static_cast<std::size_t>(block);
    live[b] = live_rows(cells, box_of(cell_of(field.keys[b]), field.cell), field.cell);
  });
  int count = 0;
  for (const RowSet rows : live) field.stored.push_back(rows != 0 ? count++ : -1);
  field.values.resize(static_cast<std::size_t>(count));
  return live;
}

}  // namespace

Field make_field(const ParticleCells& cells, const Splats& splats, float cell, Executor& executor) {
  Field field;
  field.cell = cell;
  field.keys = reached_blocks(splats, cell);
  field.table = KeyTable(field.keys.size());
  for (const std::uint64_t key : field.keys) field.table.insert(key);
  const std::vector<RowSet> live = store_blocks(field, cells, executor);
  executor.parallel_for("surface: field", field.size(), [&](int block) {
    const std::size_t b = static_cast<std::size_t>(block);
    const int place = field.stored[b];
    if (place < 0) return;
    const Box box = box_of(cell_of(field.keys[b]), cell);
    evaluate(cells, splats, box, cell, live[b], field.values[static_cast<std::size_t>(place)]);
  });
  return field;
}

}  // namespace pliant::surface
