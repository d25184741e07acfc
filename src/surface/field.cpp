// Adds the kernels at the nodes of the blocks that they reach.
#include "surface/field.h"

#include <algorithm>

#include "core/at.h"
#include "parallel/ranges.h"
#include "surface/reached_blocks.h"

namespace pliant::surface {

namespace {

using BrickValues = std::array<float, brick_nodes>;

const float* full_brick() {
  static const BrickValues ones = [] {
    BrickValues values;
    values.fill(1);
    return values;
  }();
  return ones.data();
}

/// The first node of a brick, in cells from that of its block.
Vec3f corner_of(int brick) {
  constexpr auto side = static_cast<float>(brick_side);
  return {(brick & 1) != 0 ? side : 0, (brick & 2) != 0 ? side : 0, (brick & 4) != 0 ? side : 0};
}

/// What all blocks are made of.
struct Sources {
  const ParticleCells& cells;
  const Splats& splats;
  const ReachedBlocks& reached;
  const SurfaceKernels& kernels;
  float cell;
};

/// Kernels that reach a block, and memory for a brick's.
class KernelList {
 public:
  void clear() { count_ = 0; }
  /// Appends those that reach the box.
  void add(const Sources& from, const ParticleRange& range, const Box& box) {
    make_room(at(count_ + range.last - range.first + 16));
    count_ = from.kernels.gather(rows_of(from.cells, from.splats), range, box, count_, rows<float>(), numbers_.data());
  }
  /// Those of the list that reach a smaller box.
  std::span<const int> choose(const SurfaceKernels& kernels, const Box& box) {
    const int chosen = kernels.choose(rows<const float>(), numbers_.data(), count_, box, chosen_.data());
    return {chosen_.data(), at(chosen)};
  }

 private:
  template <class Float>
  SplatRows<Float> rows() {
    const auto row = [&](std::size_t i) { return rows_[i].data(); };
    return {{row(0), row(1), row(2)}, {row(3), row(4), row(5), row(6)}};
  }
  void make_room(std::size_t size) {
    if (size <= numbers_.size()) return;
    for (std::vector<float>& row : rows_) row.resize(2 * size);
    numbers_.resize(2 * size);
    chosen_.resize(2 * size);
  }

  int count_ = 0;
  std::array<std::vector<float>, 7> rows_;
  std::vector<int> numbers_, chosen_;
};

std::span<const Keyed> cells_of(const ReachedBlocks& reached, int block) {
  return {reached.cells.data() + reached.first[at(block)], reached.cells.data() + reached.first[at(block) + 1]};
}

Vec3f origin_of(const Sources& from, int block) {
  const Cell cell = cell_of(from.reached.keys[at(block)]);
  const float side = static_cast<float>(block_side) * from.cell;
  return {static_cast<float>(cell.x) * side, static_cast<float>(cell.y) * side, static_cast<float>(cell.z) * side};
}

/// The box of `side` nodes along each axis.
Box box_of(const Vec3f& low, int side, float cell) {
  const float extent = static_cast<float>(side - 1) * cell;
  return {low, low + Vec3f{extent, extent, extent}};
}

/// True if all nodes in a box are in enclosed cells of particles: the surface is far.
bool is_deep(const ParticleCells& cells, const Box& box) {
  const float per_side = 1 / cells.side,
              margin = 1e-3f * cells.side;  // a node between two cells may count as in either
  const Vec3f more{margin, margin, margin};
  const Cell low = cell_at(box.low + more, per_side), high = cell_at(box.high + more, per_side);
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) {
        const int cell = cells.find({x, y, z});
        if (cell < 0 || cells.fills[at(cell)] != Fill::enclosed) return false;
      }
  return true;
}

/// A bit for each brick of a block that is deep in the liquid.
unsigned deep_bricks(const Sources& from, int block, const Vec3f& origin) {
  const auto fill = from.cells.fills.begin();
  const auto has_enclosed = [&](const Keyed& range) {
    return std::find(fill + range.first, fill + range.last, Fill::enclosed) != fill + range.last;
  };
  const std::span<const Keyed> cells = cells_of(from.reached, block);
  if (std::none_of(cells.begin(), cells.end(), has_enclosed)) return 0;
  unsigned deep = 0;
  for (int brick = 0; brick < block_bricks; ++brick)
    if (is_deep(from.cells, box_of(origin + corner_of(brick) * from.cell, brick_side, from.cell))) deep |= 1U << brick;
  return deep;
}

/// Lists the kernels that reach a block, in the order of particles.
void list_kernels(const Sources& from, int block, const Vec3f& origin, KernelList& list) {
  const Box box = box_of(origin, block_side, from.cell);
  list.clear();
  for (const Keyed& range : cells_of(from.reached, block))
    list.add(from, {from.cells.first[at(range.first)], from.cells.first[at(range.last)]}, box);
}

/// Keeps the bricks in `values` that have some, of which `places` says which; -1 if one has none.
void store(const std::array<BrickValues, block_bricks>& values, int count, const std::array<int, block_bricks>& places,
           FieldBlock& block) {
  block.storage = std::unique_ptr<float[]>(new float[at(count * brick_nodes)]);
  for (int brick = 0; brick < block_bricks; ++brick) {
    const int place = places[at(brick)];
    if (place < 0) continue;
    float* const to = block.storage.get() + place * brick_nodes;
    std::copy_n(values[at(place)].data(), brick_nodes, to);
    block.values[at(brick)] = to;
  }
}

void evaluate(const Sources& from, int number, KernelList& list, FieldBlock& block) {
  const Vec3f origin = origin_of(from, number);
  const unsigned deep = deep_bricks(from, number, origin);
  if (deep != 0xff) list_kernels(from, number, origin, list);
  std::array<BrickValues, block_bricks> values;
  std::array<int, block_bricks> places;
  int count = 0;
  for (int brick = 0; brick < block_bricks; ++brick) {
    const std::size_t b = at(brick);
    const bool is_full = (deep >> brick & 1U) != 0;
    places[b] = -1;
    block.values[b] = is_full ? full_brick() : empty_brick();
    block.inside[b] = is_full ? ~NodeSet{0} : 0;
    if (is_full) continue;
    const Vec3f corner = corner_of(brick);
    const std::span<const int> chosen =
        list.choose(from.kernels, box_of(origin + corner * from.cell, brick_side, from.cell));
    if (chosen.empty()) continue;
    places[b] = count++;
    block.inside[b] = from.kernels.sum(from.splats.all.data(), chosen.data(), static_cast<int>(chosen.size()),
                                       {origin, corner, from.cell, surface_level}, values[at(places[b])].data());
  }
  if (count > 0) store(values, count, places, block);
}

}  // namespace

const float* empty_brick() {
  static constexpr BrickValues zeros{};
  return zeros.data();
}

float Field::at(int block, int node) const {
  const int x = node % block_side, y = node / block_side % block_side, z = node / (block_side * block_side);
  const int brick = x / brick_side | y / brick_side << 1 | z / brick_side << 2;
  const int place = x % brick_side + brick_side * (y % brick_side + brick_side * (z % brick_side));
  return blocks[pliant::at(block)].values[pliant::at(brick)][place];
}

Field make_field(const ParticleCells& cells, const Splats& splats, float cell, Executor& executor,
                 const SurfaceKernels& kernels) {
  ReachedBlocks reached = find_blocks(splats, static_cast<float>(block_side) * cell, cell, executor);
  Field field;
  field.cell = cell;
  field.table = KeyTable(reached.keys.size());
  for (const std::uint64_t key : reached.keys) field.table.insert(key);
  field.blocks.resize(reached.keys.size());
  constexpr int blocks_at_a_time = 16;
  const Sources from{cells, splats, reached, kernels, cell};
  for_ranges(executor, "surface: field", static_cast<int>(reached.keys.size()), blocks_at_a_time,
             [&](int first, int last) {
               KernelList list;
               for (int block = first; block < last; ++block) evaluate(from, block, list, field.blocks[at(block)]);
             });
  field.keys = std::move(reached.keys);
  return field;
}

}  // namespace pliant::surface
