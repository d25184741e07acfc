#include "collision/near/clearance.h"

#include <algorithm>
#include <limits>

#include "collision/broad/morton.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// Upper bound of the relative rounding error of a squared float distance.
constexpr float squared_slack = 1e-5f;

PlaceRows rows_of(std::array<std::vector<float>, 3>& place) {
  return {{place[0].data(), place[1].data(), place[2].data()}};
}

template <class T>
void fill_up(std::vector<T>& list) {
  while (list.size() % 16 != 0) list.push_back(list.back());
}

/// The rank of each vertex along a Morton curve.
std::vector<int> ranks(const std::vector<Record>& rest) {
  std::vector<Vec3f> places;
  places.reserve(rest.size());
  for (const Record& x : rest) places.push_back({x.x, x.y, x.z});
  std::vector<int> order, rank(places.size());
  MortonSorter().sort(places, order);
  for (std::size_t i = 0; i < order.size(); ++i) rank[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  return rank;
}

}  // namespace

Clearance::Clearance(const std::vector<Piece>& pieces, const std::vector<Record>& rest, const std::vector<Line>& joined) {
  const std::vector<int> rank = ranks(rest);
  start_.push_back(0);
  line_start_.push_back(0);
  for (Piece piece : pieces) {
    std::sort(piece.vertices.begin(), piece.vertices.end(), [&](int a, int b) { return rank[a] < rank[b]; });
    fill_up(piece.vertices);
    fill_up(piece.lines);
    vertex_.insert(vertex_.end(), piece.vertices.begin(), piece.vertices.end());
    for (const Line& line : piece.lines)
      for (std::size_t end = 0; end < 2; ++end) line_[end].push_back(line[end]);
    start_.push_back(static_cast<int>(vertex_.size()));
    line_start_.push_back(static_cast<int>(line_[0].size()));
  }
  for (std::vector<float>& row : place_) row.resize(vertex_.size());
  batch_box_.resize(vertex_.size() / 16);
  longest_.resize(pieces.size());
  leave_out(joined, rest.size());
}

void Clearance::leave_out(const std::vector<Line>& joined, std::size_t vertices) {
  std::vector<std::vector<std::int32_t>> places(vertices);
  for (std::size_t i = 0; i < vertex_.size(); ++i) places[vertex_[i]].push_back(static_cast<std::int32_t>(i));
  std::vector<std::vector<std::int32_t>> near = places;
  for (const auto& [v, u] : joined) near[v].insert(near[v].end(), places[u].begin(), places[u].end());
  for (std::vector<std::int32_t>& list : near) std::sort(list.begin(), list.end());
  for (const std::int32_t v : vertex_) {
    const std::size_t start = left_out_.size();
    left_out_start_.push_back(static_cast<std::int32_t>(start));
    for (const std::int32_t place : near[v]) {
      if (left_out_.size() == start || left_out_.back().batch != place / 16) left_out_.push_back({place / 16, 0});
      left_out_.back().bits |= 1U << (place % 16);
    }
    left_out_.push_back({std::numeric_limits<std::int32_t>::max(), 0});
  }
}

void Clearance::place(const PairKernels& kernels, int piece, const Record* positions) {
  const int first = start_[piece], last = start_[piece + 1];
  kernels.gather_places(vertex_.data(), first, last, positions, rows_of(place_));
  const auto at = [&](int i) { return Vec3f{place_[0][i], place_[1][i], place_[2][i]}; };
  for (int i = first; i < last; i += 16) {
    BoxBounds box{at(i), at(i)};
    for (int k = i + 1; k < i + 16; ++k) box = {min(box.low, at(k)), max(box.high, at(k))};
    batch_box_[i / 16] = box;
  }
  longest_[piece] = kernels.longest_squared({{line_[0].data(), line_[1].data(), nullptr}, 2}, line_start_[piece],
                                            line_start_[piece + 1], positions);
}

float Clearance::between(const PairKernels& kernels, int a, int b, float wanted, std::vector<std::int32_t>& scratch) {
  const float sizes = max(0.25f * (longest_[a] + longest_[b]), max(longest_[a], longest_[b]) / 3) * (1 + squared_slack),
              beyond = (wanted * wanted + sizes) * (1 + 8 * squared_slack), reach = sqrt(beyond) * (1 + squared_slack);
  const int first = start_[b] / 16, last = start_[b + 1] / 16;
  const BoxBounds far = BoxBounds::merged(&batch_box_[first], last - first).grown(reach);
  const float far_box[6] = {far.low.x, far.low.y, far.low.z, far.high.x, far.high.y, far.high.z};
  float least = beyond;
  for (int rows = start_[a] / 16; rows < start_[a + 1] / 16; ++rows) {
    if (!overlap(batch_box_[rows], far)) continue;
    const BoxBounds own = batch_box_[rows].grown(reach);
    scratch.clear();
    for (int k = a == b ? rows : first; k < last; ++k)
      if (overlap(own, batch_box_[k])) scratch.push_back(k);
    const VertexComparison all{rows_of(place_),  16 * rows,
                               far_box,          rows_of(place_),
                               scratch.data(),   static_cast<int>(scratch.size()),
                               left_out_.data(), left_out_start_.data()};
    least = min(least, kernels.least_squared(all, beyond));
  }
  return min(wanted, sqrt(max(0.f, least * (1 - squared_slack) - sizes)) * (1 - squared_slack));
}

}  // namespace pliant
