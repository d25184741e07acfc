// Sorts particles into cells by a radix sort, which is stable.
#include "surface/particle_cells.h"

#include <algorithm>
#include <utility>

#include "parallel/ranges.h"

namespace pliant::surface {

namespace {

constexpr int digit_bits = 11;
constexpr std::size_t digits = std::size_t{1} << digit_bits;

/// A particle and the key of its cell, in which the bits that all keys share are left out.
struct Item {
  std::uint64_t key;
  int particle;
};

int bits_of(int extent) {
  int bits = 0;
  while (bits < 31 && extent >> bits != 0) ++bits;
  return bits;
}

/// The smallest box of cells with all particles, and the bits of a coordinate in it.
struct KeyBox {
  Cell low{key_range, key_range, key_range}, high{-key_range, -key_range, -key_range};
  int x_bits = 0, y_bits = 0, z_bits = 0;

  void include(const Cell& c) {
    low = {std::min(low.x, c.x), std::min(low.y, c.y), std::min(low.z, c.z)};
    high = {std::max(high.x, c.x), std::max(high.y, c.y), std::max(high.z, c.z)};
  }
  void count_bits() {
    x_bits = bits_of(high.x - low.x);
    y_bits = bits_of(high.y - low.y);
    z_bits = bits_of(high.z - low.z);
  }
  int bits() const { return x_bits + y_bits + z_bits; }
  std::uint64_t key(const Cell& c) const {
    const auto part = [](int i) { return static_cast<std::uint64_t>(i); };
    return (part(c.z - low.z) << y_bits | part(c.y - low.y)) << x_bits | part(c.x - low.x);
  }
};

/// Sorts by keys of so many bits, least significant digits first.
void sort_by_key(std::vector<Item>& items, int bits) {
  std::vector<Item> sorted(items.size());
  for (int shift = 0; shift < bits; shift += digit_bits) {
    std::vector<std::size_t> place(digits + 1, 0);
    for (const Item& item : items) ++place[(item.key >> shift & (digits - 1)) + 1];
    for (std::size_t d = 0; d < digits; ++d) place[d + 1] += place[d];
    for (const Item& item : items) sorted[place[item.key >> shift & (digits - 1)]++] = item;
    items.swap(sorted);
  }
}

std::vector<Item> sorted_items(std::span<const Vec3f> positions, float per_side) {
  KeyBox box;
  for (const Vec3f& p : positions) box.include(cell_at(p, per_side));
  box.count_bits();
  std::vector<Item> items(positions.size());
  for (std::size_t i = 0; i < items.size(); ++i) items[i] = {box.key(cell_at(positions[i], per_side)), static_cast<int>(i)};
  sort_by_key(items, box.bits());
  return items;
}

/// At rest a cell has eight particles. With five it is not split by a surface, or has at most the outermost layer of one.
constexpr int full_count = 5;

void find_fills(ParticleCells& cells, Executor& executor) {
  const auto is_full = [&](int cell) { return cell >= 0 && cells.particles(cell).size() >= full_count; };
  cells.fills.assign(cells.keys.size(), Fill::sparse);
  for_items(executor, "surface: fills", cells.size(), 512, [&](int cell) {
    if (!is_full(cell)) return;
    const std::array<int, 27> around = cells_around(cells, cell);
    const bool is_enclosed = std::all_of(around.begin(), around.end(), is_full);
    cells.fills[static_cast<std::size_t>(cell)] = is_enclosed ? Fill::enclosed : Fill::full;
  });
}

}  // namespace

ParticleCells sort_into_cells(std::span<const Vec3f> positions, float spacing, Executor& executor) {
  ParticleCells cells;
  cells.side = 2 * spacing;
  const float per_side = 1 / cells.side;
  const std::vector<Item> items = sorted_items(positions, per_side);
  cells.positions.reserve(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Vec3f& p = positions[static_cast<std::size_t>(items[i].particle)];
    if (i == 0 || items[i].key != items[i - 1].key) {
      cells.keys.push_back(key_of(cell_at(p, per_side)));
      cells.first.push_back(static_cast<int>(i));
    }
    cells.positions.push_back(p);
  }
  cells.first.push_back(static_cast<int>(items.size()));
  cells.table = KeyTable(cells.keys.size());
  for (const std::uint64_t key : cells.keys) cells.table.insert(key);
  find_fills(cells, executor);
  return cells;
}

std::array<int, 27> cells_around(const ParticleCells& cells, int cell) {
  const Cell c = cell_of(cells.keys[static_cast<std::size_t>(cell)]);
  std::array<int, 27> around{};
  std::size_t n = 0;
  for (int z = c.z - 1; z <= c.z + 1; ++z)
    for (int y = c.y - 1; y <= c.y + 1; ++y)
      for (int x = c.x - 1; x <= c.x + 1; ++x) around[n++] = cells.find({x, y, z});
  return around;
}

}  // namespace pliant::surface
