#include "collision/neighbours/cell_order.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace pliant {

namespace {

/// Places beyond this many columns from the origin share the outermost cells.
constexpr std::int32_t farthest = (1 << 20) - 1;  // so that three places fit in a key
constexpr int digit_bits = 11;

/// The largest whole number that is not above `x`, within the grid; for NaN its end.
std::int32_t whole(float x) {
  if (!(x > -static_cast<float>(farthest))) return -farthest;
  if (!(x < static_cast<float>(farthest))) return farthest;
  const auto down = static_cast<std::int32_t>(x);
  return down - (static_cast<float>(down) > x ? 1 : 0);
}

int bits_for(std::int32_t range) {
  int bits = 0;
  for (; range > 0; range >>= 1) ++bits;
  return bits;
}

/// True if the rows of a layer run backwards, or the columns of a row.
bool runs_back(std::int32_t place) { return (place & 1) != 0; }

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

}  // namespace

CellOrder::Cell CellOrder::cell_of(float x, float y, float z) const {
  return {whole(x * (2 * inverse_cell_)), whole(y * inverse_cell_), whole(z * inverse_cell_)};
}

void CellOrder::make_keys(std::span<const Record> points) {
  least_ = {farthest, farthest, farthest};
  most_ = {-farthest, -farthest, -farthest};
  cells_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Cell c = cells_[i] = cell_of(points[i].x, points[i].y, points[i].z);
    least_ = {std::min(least_.column, c.column), std::min(least_.layer, c.layer), std::min(least_.row, c.row)};
    most_ = {std::max(most_.column, c.column), std::max(most_.layer, c.layer), std::max(most_.row, c.row)};
  }
  column_bits_ = bits_for(most_.column - least_.column);
  row_bits_ = bits_for(most_.row - least_.row);
  layer_bits_ = bits_for(most_.layer - least_.layer);
  keys_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Cell& c = cells_[i];
    const auto from = [](std::int32_t place, std::int32_t least, std::int32_t most, bool back) {
      return static_cast<std::uint64_t>(back ? most - place : place - least);
    };
    keys_[i] = (static_cast<std::uint64_t>(c.layer - least_.layer) << row_bits_ |
                from(c.row, least_.row, most_.row, runs_back(c.layer)))
                   << column_bits_ |
               from(c.column, least_.column, most_.column, runs_back(c.layer + c.row));
  }
}

void CellOrder::sort_by_digit(int shift) {
  constexpr std::uint64_t mask = (1u << digit_bits) - 1;
  std::array<std::int32_t, (1 << digit_bits) + 1> begin{};
  for (const std::uint64_t key : keys_) ++begin[at((key >> shift) & mask) + 1];
  if (std::find(begin.begin(), begin.end(), static_cast<std::int32_t>(keys_.size())) != begin.end())
    return;  // all are equal
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  keys_before_.swap(keys_);
  order_before_.swap(order_);
  for (std::size_t i = 0; i < keys_before_.size(); ++i) {
    const std::size_t to = at(begin[at((keys_before_[i] >> shift) & mask)]++);
    keys_[to] = keys_before_[i];
    order_[to] = order_before_[i];
  }
}

void CellOrder::sort_keys() {
  keys_before_.resize(keys_.size());
  order_before_.resize(keys_.size());
  order_.resize(keys_.size());
  std::iota(order_.begin(), order_.end(), 0);
  for (int shift = 0; shift < column_bits_ + row_bits_ + layer_bits_; shift += digit_bits) sort_by_digit(shift);
}

void CellOrder::list_rows() {
  rows_.clear();
  layers_.clear();
  const auto slots = static_cast<std::int32_t>(order_.size());
  for (std::int32_t slot = 0; slot < slots; ++slot) {
    const Cell& c = cells_[at(slot)];
    const bool is_new_layer = slot == 0 || c.layer != layers_.back().layer;
    if (is_new_layer || c.row != rows_.back().row) {
      const auto row = static_cast<std::int32_t>(rows_.size());
      if (is_new_layer) layers_.push_back({c.layer, row, row});
      rows_.push_back({c.row, slot, slot});
    }
    rows_.back().last = slot + 1;
    layers_.back().last = static_cast<std::int32_t>(rows_.size());
  }
}

void CellOrder::sort(std::span<const Record> points, float cell) {
  inverse_cell_ = 1 / cell;
  make_keys(points);
  sort_keys();
  std::vector<Cell> by_slot(cells_.size());
  for (std::size_t slot = 0; slot < by_slot.size(); ++slot) by_slot[slot] = cells_[at(order_[slot])];
  cells_.swap(by_slot);
  list_rows();
}

/// The first slot of a row whose column is at or after `column` in the row's direction.
std::int32_t CellOrder::first_column(const Row& row, bool back, std::int32_t column) const {
  const auto first = cells_.begin() + row.first, last = cells_.begin() + row.last;
  const auto is_before = [back](const Cell& c, std::int32_t than) { return back ? c.column > than : c.column < than; };
  return static_cast<std::int32_t>(std::lower_bound(first, last, column, is_before) - cells_.begin());
}

void CellOrder::find(const Vec3f& low, const Vec3f& high, std::vector<SlotRange>& ranges) const {
  ranges.clear();
  const Cell a = cell_of(low.x, low.y, low.z), b = cell_of(high.x, high.y, high.z);
  const auto layer_before = [](const Layer& layer, std::int32_t than) { return layer.layer < than; };
  auto layer = std::lower_bound(layers_.begin(), layers_.end(), a.layer, layer_before);
  for (; layer != layers_.end() && layer->layer <= b.layer; ++layer) {
    const bool back = runs_back(layer->layer);
    const auto row_before = [back](const Row& row, std::int32_t than) { return back ? row.row > than : row.row < than; };
    const auto last = rows_.begin() + layer->last;
    auto row = std::lower_bound(rows_.begin() + layer->first, last, back ? b.row : a.row, row_before);
    for (; row != last && row->row >= a.row && row->row <= b.row; ++row) {
      const bool turned = runs_back(layer->layer + row->row);
      const SlotRange range{first_column(*row, turned, turned ? b.column : a.column),
                            first_column(*row, turned, turned ? a.column - 1 : b.column + 1)};
      if (range.first == range.last) continue;
      if (!ranges.empty() && ranges.back().last == range.first)
        ranges.back().last = range.last;
      else
        ranges.push_back(range);
    }
  }
}

}  // namespace pliant
