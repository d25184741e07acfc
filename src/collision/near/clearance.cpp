#include "collision/near/clearance.h"

#include <algorithm>
#include <limits>

#include "collision/broad/morton.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// Upper bound of the relative rounding error of a squared float distance.
constexpr float squared_slack = 1e-5f;

PlaceRows rows_of(std::array<AlignedVector<float>, 3>& place) {
  return {{place[0].data(), place[1].data(), place[2].data()}};
}

template <class T>
void fill_up(std::vector<T>& list) {
  while (list.size() % 16 != 0) list.push_back(list.back());
}

/// Returns the rank of each vertex of a block along a Morton curve, indexed from the block's first vertex on.
std::vector<int> ranks(const std::vector<Record>& rest, const Block& vertices) {
  std::vector<Vec3f> places;
  places.reserve(static_cast<std::size_t>(vertices.size));
  for (int v = vertices.first; v < vertices.end(); ++v) places.push_back({rest[v].x, rest[v].y, rest[v].z});
  std::vector<int> order, rank(places.size());
  MortonSorter().sort(places, order);
  for (std::size_t i = 0; i < order.size(); ++i) rank[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  return rank;
}

}  // namespace

void Clearance::add(int body, int first_piece, std::vector<Piece> pieces, const std::vector<Record>& rest,
                    const Block& vertices, const std::vector<Line>& joined) {
  const std::vector<int> rank = ranks(rest, vertices);
  int vertex_count = 0, line_count = 0;
  for (Piece& piece : pieces) {
    std::sort(piece.vertices.begin(), piece.vertices.end(),
              [&](int a, int b) { return rank[a - vertices.first] < rank[b - vertices.first]; });
    fill_up(piece.vertices);
    fill_up(piece.lines);
    vertex_count += static_cast<int>(piece.vertices.size());
    line_count += static_cast<int>(piece.lines.size());
  }
  int vertex = vertex_blocks_.take(body, vertex_count).first, line = line_blocks_.take(body, line_count).first;
  vertex_.resize(vertex_blocks_.end());
  for (std::vector<std::int32_t>& ends : line_) ends.resize(line_blocks_.end());
  pieces_.resize(std::max(pieces_.size(), static_cast<std::size_t>(first_piece) + pieces.size()));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Stored& stored = pieces_[static_cast<std::size_t>(first_piece) + i];
    stored = {vertex, vertex, line, line};
    for (const std::int32_t v : pieces[i].vertices) vertex_[stored.last++] = v;
    for (const Line& ends : pieces[i].lines) {
      for (std::size_t end = 0; end < 2; ++end) line_[end][stored.last_line] = ends[end];
      ++stored.last_line;
    }
    vertex = stored.last;
    line = stored.last_line;
  }
  for (AlignedVector<float>& row : place_) row.resize(vertex_.size());
  batch_box_.resize(vertex_.size() / 16);
  longest_.resize(pieces_.size());
  leave_out(body, vertices, joined);
}

void Clearance::remove(int body) {
  vertex_blocks_.release(body);
  line_blocks_.release(body);
  left_out_blocks_.release(body);
}

void Clearance::leave_out(int body, const Block& vertices, const std::vector<Line>& joined) {
  const Block stored = vertex_blocks_[body];
  std::vector<std::vector<std::int32_t>> places(static_cast<std::size_t>(vertices.size));
  for (int i = stored.first; i < stored.end(); ++i) places[vertex_[i] - vertices.first].push_back(i);
  std::vector<std::vector<std::int32_t>> near = places;
  for (const auto& [v, u] : joined) {
    const std::vector<std::int32_t>& others = places[u - vertices.first];
    near[v - vertices.first].insert(near[v - vertices.first].end(), others.begin(), others.end());
  }
  for (std::vector<std::int32_t>& list : near) std::sort(list.begin(), list.end());
  left_out_start_.resize(vertex_.size());
  std::vector<LeftOut> own;
  for (int i = stored.first; i < stored.end(); ++i) {
    const std::size_t start = own.size();
    left_out_start_[i] = static_cast<std::int32_t>(start);
    for (const std::int32_t place : near[vertex_[i] - vertices.first]) {
      if (own.size() == start || own.back().batch != place / 16) own.push_back({place / 16, 0});
      own.back().bits |= 1U << (place % 16);
    }
    own.push_back({std::numeric_limits<std::int32_t>::max(), 0});
  }
  const int first = left_out_blocks_.take(body, static_cast<int>(own.size())).first;
  left_out_.resize(left_out_blocks_.end());
  std::copy(own.begin(), own.end(), left_out_.begin() + first);
  for (int i = stored.first; i < stored.end(); ++i) left_out_start_[i] += first;
}

void Clearance::place(const PairKernels& kernels, int piece, const Record* positions) {
  const auto [first, last, first_line, last_line] = pieces_[piece];
  kernels.gather_places(vertex_.data(), first, last, positions, rows_of(place_));
  const auto at = [&](int i) { return Vec3f{place_[0][i], place_[1][i], place_[2][i]}; };
  for (int i = first; i < last; i += 16) {
    BoxBounds box{at(i), at(i)};
    for (int k = i + 1; k < i + 16; ++k) box = {min(box.low, at(k)), max(box.high, at(k))};
    batch_box_[i / 16] = box;
  }
  longest_[piece] =
      kernels.longest_squared({{line_[0].data(), line_[1].data(), nullptr}, 2}, first_line, last_line, positions);
}

float Clearance::between(const PairKernels& kernels, int a, int b, float wanted, std::vector<std::int32_t>& scratch) {
  const float sizes = max(0.25f * (longest_[a] + longest_[b]), max(longest_[a], longest_[b]) / 3) * (1 + squared_slack),
              beyond = (wanted * wanted + sizes) * (1 + 8 * squared_slack), reach = sqrt(beyond) * (1 + squared_slack);
  const int first = pieces_[b].first / 16, last = pieces_[b].last / 16;
  const BoxBounds far = BoxBounds::merged(&batch_box_[first], last - first).grown(reach);
  const float far_box[6] = {far.low.x, far.low.y, far.low.z, far.high.x, far.high.y, far.high.z};
  float least = beyond;
  for (int rows = pieces_[a].first / 16; rows < pieces_[a].last / 16; ++rows) {
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
