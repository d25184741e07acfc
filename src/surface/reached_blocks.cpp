// Lists what each cell of particles reaches, and sorts that by block.
#include "surface/reached_blocks.h"

#include <algorithm>
#include <utility>

#include "core/at.h"
#include "parallel/ranges.h"

namespace pliant::surface {

namespace {

struct CellBox {
  Cell low, high;
};

CellBox blocks_of(const Box& box, float margin, float per_side) {
  const Vec3f more{margin, margin, margin};
  return {cell_at(box.low - more, per_side), cell_at(box.high + more, per_side)};
}

/// Lists blocks with ranges of cells, in the order of the first cells. Consecutive cells mostly reach the same blocks.
class RangeList {
 public:
  void add(const Cell& block, int cell) {
    const std::uint64_t key = key_of(block);
    const auto goes_on = [&](std::size_t i) { return all_[i].key == key && all_[i].last == cell; };
    auto range = std::find_if(last_.begin(), last_.end(), goes_on);
    if (range == last_.end()) {
      now_.push_back(all_.size());
      all_.push_back({key, cell, cell + 1});
    } else {
      now_.push_back(*range);
      all_[*range].last = cell + 1;
    }
  }
  /// Must be called after the last block of a cell.
  void end_cell() {
    last_.swap(now_);
    now_.clear();
  }
  std::vector<Keyed> take() { return std::move(all_); }

 private:
  std::vector<Keyed> all_;
  std::vector<std::size_t> last_, now_;  ///< entries with the cell before and with this one
};

/// What some cells reach, with keys of the whole grid.
std::vector<Keyed> ranges_for(const Splats& splats, int first, int last, float margin, float per_side) {
  RangeList list;
  for (int cell = first; cell < last; ++cell) {
    const CellBox box = blocks_of(splats.bounds[at(cell)], margin, per_side);
    for (int z = box.low.z; z <= box.high.z; ++z)
      for (int y = box.low.y; y <= box.high.y; ++y)
        for (int x = box.low.x; x <= box.high.x; ++x) list.add({x, y, z}, cell);
    list.end_cell();
  }
  return list.take();
}

KeyBox box_of(const std::vector<Keyed>& entries) {
  KeyBox box;
  for (const Keyed& entry : entries) box.include(cell_of(entry.key));
  return box;
}

/// What all cells reach, with short keys in the box.
std::vector<Keyed> all_ranges(const Splats& splats, float margin, float per_side, KeyBox& box, Executor& executor) {
  constexpr int cells_at_a_time = 1024;
  const int cells = static_cast<int>(splats.bounds.size()), ranges = ranges_of(cells, cells_at_a_time);
  std::vector<std::vector<Keyed>> of_ranges(at(ranges));
  std::vector<KeyBox> boxes(at(ranges));
  for_ranges(executor, "surface: reach", cells, cells_at_a_time, [&](int first, int last) {
    const std::size_t range = at(first / cells_at_a_time);
    of_ranges[range] = ranges_for(splats, first, last, margin, per_side);
    boxes[range] = box_of(of_ranges[range]);
  });
  std::vector<std::size_t> before;
  std::size_t count = 0;
  for (std::size_t range = 0; range < of_ranges.size(); ++range) {
    box.include(boxes[range]);
    before.push_back(count);
    count += of_ranges[range].size();
  }
  box.count_bits();
  std::vector<Keyed> all(count);
  executor.parallel_for("surface: reach", ranges, [&](int range) {
    Keyed* to = all.data() + before[at(range)];
    for (const Keyed& entry : of_ranges[at(range)]) *to++ = {box.key(cell_of(entry.key)), entry.first, entry.last};
  });
  return all;
}

}  // namespace

ReachedBlocks find_blocks(const Splats& splats, float side, float cell, Executor& executor) {
  ReachedBlocks reached;
  KeyBox box;
  reached.cells = all_ranges(splats, cell / 4, 1 / side, box, executor);
  sort_by_key(executor, reached.cells, box.bits());
  for (std::size_t i = 0; i < reached.cells.size(); ++i) {
    if (i > 0 && reached.cells[i].key == reached.cells[i - 1].key) continue;
    reached.keys.push_back(key_of(box.cell(reached.cells[i].key)));
    reached.first.push_back(static_cast<int>(i));
  }
  reached.first.push_back(static_cast<int>(reached.cells.size()));
  return reached;
}

}  // namespace pliant::surface
