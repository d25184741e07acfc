#include "collision/neighbours/cell_order.h"

#include <algorithm>
#include <numeric>

#include "core/at.h"

namespace pliant {

namespace {

/// Places beyond this many columns from the origin share the outermost cells.
constexpr std::int32_t farthest = (1 << 20) - 1;  // so that three places fit in a key
constexpr int place_bits = 21;
/// Points that one thread handles at a time. The order does not depend on it, because sorting by a digit is stable.
constexpr std::int64_t chunk_size = 1 << 13;

/// The largest whole number that is not above `x`, within the grid; for NaN its end.
std::int32_t whole(float x) {
  constexpr auto end = static_cast<float>(farthest);
  const float within = x > -end ? (x < end ? x : end) : -end;
  const auto down = static_cast<std::int32_t>(within);
  return down - (static_cast<float>(down) > within ? 1 : 0);
}

int bits_for(std::int32_t range) {
  int bits = 0;
  for (; range > 0; range >>= 1) ++bits;
  return bits;
}

/// True if the rows of a layer run backwards, or the columns of a row.
bool runs_back(std::int32_t place) { return (place & 1) != 0; }

/// Counts a place, or an interval of them, from the first in its direction.
std::int32_t from_first(std::int32_t place, std::int32_t least, std::int32_t most, bool back) {
  return back ? most - place : place - least;
}

int chunks_of(const Executor& executor, std::size_t points) {
  if (executor.threads() == 1) return 1;
  return static_cast<int>((static_cast<std::int64_t>(points) + chunk_size - 1) / chunk_size);
}

/// Calls body(chunk, first, last) for all chunks on all threads.
template <class Body>
void for_chunks(Executor& executor, std::size_t points, const Body& body) {
  const int chunks = chunks_of(executor, points);
  const auto all = static_cast<std::int64_t>(points);
  executor.parallel_for(nullptr, chunks, [&](int chunk) {
    if (chunks == 1) return body(0, std::int64_t{0}, all);
    body(chunk, chunk * chunk_size, std::min((chunk + 1) * chunk_size, all));
  });
}

}  // namespace

CellOrder::Cell CellOrder::cell_of(float x, float y, float z) const {
  return {whole(x * (2 * inverse_cell_)), whole(y * inverse_cell_), whole(z * inverse_cell_)};
}

/// Finds the cells of points, packed into keys, and the box of all.
void CellOrder::find_cells(Executor& executor, std::span<const Record> points) {
  keys_.resize(points.size());
  boxes_.assign(at(std::max(chunks_of(executor, points.size()), 1)),
                {{farthest, farthest, farthest}, {-farthest, -farthest, -farthest}});
  for_chunks(executor, points.size(), [&](int chunk, std::int64_t first, std::int64_t last) {
    auto [least, most] = boxes_[at(chunk)];
    for (std::int64_t i = first; i < last; ++i) {
      const Record& p = points[at(i)];
      const Cell c = cell_of(p.x, p.y, p.z);
      least = {std::min(least.column, c.column), std::min(least.layer, c.layer), std::min(least.row, c.row)};
      most = {std::max(most.column, c.column), std::max(most.layer, c.layer), std::max(most.row, c.row)};
      const auto up = [](std::int32_t place) { return static_cast<std::uint64_t>(std::int64_t{place} + farthest); };
      keys_[at(i)] = (up(c.layer) << place_bits | up(c.row)) << place_bits | up(c.column);
    }
    boxes_[at(chunk)] = {least, most};
  });
  least_ = boxes_.front().least;
  most_ = boxes_.front().most;
  for (const auto& [least, most] : boxes_) {
    least_ = {std::min(least_.column, least.column), std::min(least_.layer, least.layer),
              std::min(least_.row, least.row)};
    most_ = {std::max(most_.column, most.column), std::max(most_.layer, most.layer), std::max(most_.row, most.row)};
  }
  column_bits_ = bits_for(most_.column - least_.column);
  row_bits_ = bits_for(most_.row - least_.row);
  layer_bits_ = bits_for(most_.layer - least_.layer);
}

std::uint64_t CellOrder::key_of(std::uint64_t packed_cell) const {
  constexpr std::uint64_t mask = (1u << place_bits) - 1;
  const auto down = [](std::uint64_t place) { return static_cast<std::int32_t>(place & mask) - farthest; };
  const std::int32_t column = down(packed_cell), row = down(packed_cell >> place_bits),
                     layer = down(packed_cell >> 2 * place_bits);
  const auto places = [](std::int32_t place) { return static_cast<std::uint64_t>(place); };
  return (places(layer - least_.layer) << row_bits_ | places(from_first(row, least_.row, most_.row, runs_back(layer))))
             << column_bits_ |
         places(from_first(column, least_.column, most_.column, runs_back(layer + row)));
}

/// Sorts by some bits of the keys. Returns false if these are equal in all.
bool CellOrder::sort_by_digit(Executor& executor, int shift, int bits) {
  const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  const std::size_t digits = std::size_t{1} << bits;
  for_chunks(executor, keys_.size(), [&](int chunk, std::int64_t first, std::int64_t last) {
    Counts& counts = counts_[at(chunk)];
    std::fill_n(counts.begin(), digits, 0);
    for (std::int64_t i = first; i < last; ++i) ++counts[(keys_[at(i)] >> shift) & mask];
  });
  std::int32_t sum = 0;
  for (std::size_t digit = 0; digit < digits; ++digit) {
    const std::int32_t before = sum;
    for (Counts& counts : counts_) {
      const std::int32_t count = counts[digit];
      counts[digit] = sum;
      sum += count;
    }
    if (sum - before == static_cast<std::int32_t>(keys_.size())) return false;
  }
  for_chunks(executor, keys_.size(), [&](int chunk, std::int64_t first, std::int64_t last) {
    Counts& next = counts_[at(chunk)];
    for (std::int64_t i = first; i < last; ++i) {
      const std::size_t to = at(next[(keys_[at(i)] >> shift) & mask]++);
      keys_before_[to] = keys_[at(i)];
      order_before_[to] = order_[at(i)];
    }
  });
  return true;
}

void CellOrder::sort_keys(Executor& executor) {
  keys_before_.resize(keys_.size());
  order_before_.resize(keys_.size());
  order_.resize(keys_.size());
  counts_.resize(at(std::max(chunks_of(executor, keys_.size()), 1)));
  for_chunks(executor, keys_.size(), [&](int /*chunk*/, std::int64_t first, std::int64_t last) {
    std::iota(order_.begin() + first, order_.begin() + last, static_cast<std::int32_t>(first));
    for (std::int64_t i = first; i < last; ++i) keys_[at(i)] = key_of(keys_[at(i)]);
  });
  const int all = column_bits_ + row_bits_ + layer_bits_;
  const int digits = (all + most_digit_bits - 1) / most_digit_bits, bits = digits > 0 ? (all + digits - 1) / digits : 0;
  for (int digit = 0; digit < digits; ++digit) {
    if (!sort_by_digit(executor, digit * bits, bits)) continue;
    keys_.swap(keys_before_);
    order_.swap(order_before_);
  }
}

std::int32_t CellOrder::column_of(std::int32_t slot) const {
  return static_cast<std::int32_t>(keys_[at(slot)] & ((std::uint64_t{1} << column_bits_) - 1));
}

/// Lists where each column starts, unless most of a row is empty.
void CellOrder::list_columns(Row& row) {
  constexpr std::int32_t columns_for_each = 4;
  row.column = column_of(row.first);
  row.extent = column_of(row.last - 1) - row.column;
  if (row.extent > columns_for_each * (row.last - row.first)) return;
  row.starts = static_cast<std::int64_t>(starts_.size());
  for (std::int32_t slot = row.first; slot < row.last; ++slot) {
    const std::int64_t behind = row.starts + column_of(slot) - row.column;
    while (static_cast<std::int64_t>(starts_.size()) <= behind) starts_.push_back(slot);
  }
}

void CellOrder::list_rows() {
  rows_.clear();
  layers_.clear();
  starts_.clear();
  const auto slots = static_cast<std::int32_t>(order_.size());
  for (std::int32_t slot = 0; slot < slots;) {
    const std::uint64_t row_key = keys_[at(slot)] >> column_bits_;
    std::int32_t last = slot + 1;
    while (last < slots && keys_[at(last)] >> column_bits_ == row_key) ++last;
    const auto layer = static_cast<std::int32_t>(row_key >> row_bits_);
    const auto row = static_cast<std::int32_t>(row_key & ((std::uint64_t{1} << row_bits_) - 1));
    const auto number = static_cast<std::int32_t>(rows_.size());
    if (layers_.empty() || layers_.back().place != layer) layers_.push_back({layer, number, number});
    rows_.push_back({row, slot, last});
    list_columns(rows_.back());
    layers_.back().last = number + 1;
    slot = last;
  }
}

void CellOrder::sort(Executor& executor, std::span<const Record> points, float cell) {
  inverse_cell_ = 1 / cell;
  find_cells(executor, points);
  sort_keys(executor);
  list_rows();
}

/// The first slot of a row at or behind a column.
std::int32_t CellOrder::first_at(const Row& row, std::int32_t column) const {
  const std::int32_t behind = column - row.column;
  if (behind <= 0) return row.first;
  if (behind > row.extent) return row.last;
  if (row.starts >= 0) return starts_[at(row.starts + behind)];
  const std::uint64_t wanted =
      (keys_[at(row.first)] >> column_bits_) << column_bits_ | static_cast<std::uint64_t>(column);
  const auto first = keys_.begin() + row.first, last = keys_.begin() + row.last;
  return static_cast<std::int32_t>(std::lower_bound(first, last, wanted) - keys_.begin());
}

void CellOrder::find(const Vec3f& low, const Vec3f& high, std::vector<SlotRange>& ranges) const {
  ranges.clear();
  const Cell a = cell_of(low.x, low.y, low.z), b = cell_of(high.x, high.y, high.z);
  const auto is_before = [](const auto& one, std::int32_t place) { return one.place < place; };
  auto layer = std::lower_bound(layers_.begin(), layers_.end(), a.layer - least_.layer, is_before);
  for (; layer != layers_.end() && layer->place <= b.layer - least_.layer; ++layer) {
    const std::int32_t layer_place = layer->place + least_.layer;
    const bool back = runs_back(layer_place);
    const std::int32_t first_row = from_first(back ? b.row : a.row, least_.row, most_.row, back);
    const std::int32_t last_row = from_first(back ? a.row : b.row, least_.row, most_.row, back);
    const auto last = rows_.begin() + layer->last;
    auto row = std::lower_bound(rows_.begin() + layer->first, last, first_row, is_before);
    for (; row != last && row->place <= last_row; ++row) {
      const std::int32_t row_place = back ? most_.row - row->place : row->place + least_.row;
      const bool turned = runs_back(layer_place + row_place);
      const std::int32_t from = from_first(turned ? b.column : a.column, least_.column, most_.column, turned);
      const std::int32_t to = from_first(turned ? a.column : b.column, least_.column, most_.column, turned);
      const SlotRange range{first_at(*row, from), first_at(*row, to + 1)};
      if (range.first == range.last) continue;
      if (!ranges.empty() && ranges.back().last == range.first)
        ranges.back().last = range.last;
      else
        ranges.push_back(range);
    }
  }
}

}  // namespace pliant
