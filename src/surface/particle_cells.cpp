// Sorts particles into cells, and finds which of these are deep in the liquid.
#include "surface/particle_cells.h"

#include <algorithm>

#include "core/at.h"
#include "parallel/ranges.h"
#include "surface/sort_keys.h"

namespace pliant::surface {

namespace {

constexpr int particles_at_a_time = 1 << 13;

KeyBox box_of(std::span<const Vec3f> positions, float per_side, Executor& executor) {
  const int count = static_cast<int>(positions.size());
  std::vector<KeyBox> boxes(at(ranges_of(count, particles_at_a_time)));
  for_ranges(executor, "surface: box", count, particles_at_a_time, [&](int first, int last) {
    KeyBox box;
    for (int i = first; i < last; ++i) box.include(cell_at(positions[at(i)], per_side));
    boxes[at(first / particles_at_a_time)] = box;
  });
  KeyBox all;
  for (const KeyBox& box : boxes) all.include(box);
  all.count_bits();
  return all;
}

/// The particles by cells.
std::vector<Keyed> sorted_particles(std::span<const Vec3f> positions, const KeyBox& box, float per_side,
                                    Executor& executor) {
  std::vector<Keyed> items(positions.size());
  for_items(executor, "surface: keys", static_cast<int>(items.size()), particles_at_a_time, [&](int i) {
    items[at(i)] = {box.key(cell_at(positions[at(i)], per_side)), i, i + 1};
  });
  sort_by_key(executor, items, box.bits());
  return items;
}

void take_positions(ParticleCells& cells, std::span<const Vec3f> positions, const std::vector<Keyed>& order,
                    Executor& executor) {
  cells.positions.resize(order.size());
  for (std::vector<float>* const along : {&cells.x, &cells.y, &cells.z}) along->resize(order.size() + 16);
  for_items(executor, "surface: places", static_cast<int>(order.size()), particles_at_a_time, [&](int place) {
    const std::size_t i = at(place);
    const Vec3f p = positions[at(order[i].first)];
    cells.positions[i] = p;
    cells.x[i] = p.x, cells.y[i] = p.y, cells.z[i] = p.z;
  });
}

void list_cells(ParticleCells& cells, const std::vector<Keyed>& order, const KeyBox& box) {
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && order[i].key == order[i - 1].key) continue;
    cells.keys.push_back(key_of(box.cell(order[i].key)));
    cells.first.push_back(static_cast<int>(i));
  }
  cells.first.push_back(static_cast<int>(order.size()));
  cells.table = KeyTable(cells.keys.size());
  for (const std::uint64_t key : cells.keys) cells.table.insert(key);
}

/// At rest a cell has eight particles. With five it is not split by a surface, or has at most the outermost layer of
/// one.
constexpr int full_count = 5;

void find_fills(ParticleCells& cells, Executor& executor) {
  constexpr int cells_at_a_time = 256;
  const auto is_full = [&](int cell) { return cells.first[at(cell) + 1] - cells.first[at(cell)] >= full_count; };
  const auto is_full_row = [&](const CellRow& row) {
    return row.last - row.first == 3 && is_full(row.first) && is_full(row.first + 1) && is_full(row.first + 2);
  };
  cells.fills.assign(cells.keys.size(), Fill::sparse);
  for_ranges(executor, "surface: fills", cells.size(), cells_at_a_time, [&](int first, int last) {
    CellsAround around(cells, first);
    for (int cell = first; cell < last; ++cell) {
      if (!is_full(cell)) continue;
      const std::array<CellRow, 9> rows = around.of(cell);
      const bool is_enclosed = std::all_of(rows.begin(), rows.end(), is_full_row);
      cells.fills[at(cell)] = is_enclosed ? Fill::enclosed : Fill::full;
    }
  });
}

/// The keys of the rows around a cell, as steps from its own to the first of each.
std::uint64_t step_to_cell_row(int row) { return key_step(-1, row % 3 - 1, row / 3 - 1); }

}  // namespace

ParticleCells sort_into_cells(std::span<const Vec3f> positions, float spacing, Executor& executor) {
  ParticleCells cells;
  cells.side = 2 * spacing;
  const float per_side = 1 / cells.side;
  const KeyBox box = box_of(positions, per_side, executor);
  const std::vector<Keyed> order = sorted_particles(positions, box, per_side, executor);
  take_positions(cells, positions, order, executor);
  list_cells(cells, order, box);
  find_fills(cells, executor);
  return cells;
}

CellsAround::CellsAround(const ParticleCells& cells, int cell) : cells_(cells) {
  for (int row = 0; row < 9; ++row)
    rows_[at(row)] = KeyFollower(cells.keys, cells.keys[at(cell)] + step_to_cell_row(row));
}

std::array<CellRow, 9> CellsAround::of(int cell) {
  std::array<CellRow, 9> found{};
  for (int row = 0; row < 9; ++row) {
    const std::uint64_t low = cells_.keys[at(cell)] + step_to_cell_row(row);
    const int first = rows_[at(row)].first_from(low);
    int last = first;
    while (last < cells_.size() && cells_.keys[at(last)] <= low + 2) ++last;
    found[at(row)] = {first, last};
  }
  return found;
}

}  // namespace pliant::surface
