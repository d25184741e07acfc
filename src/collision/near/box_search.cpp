#include "collision/near/box_search.h"

#include <algorithm>

namespace pliant {

namespace {

/// Returns the least or largest of sixteen numbers. It halves the list repeatedly, which compilers do in SIMD
/// registers.
template <class Extreme>
float extreme_of_sixteen(const float* values, const Extreme& extreme) {
  float eight[8], four[4];
  for (int i = 0; i < 8; ++i) eight[i] = extreme(values[i], values[i + 8]);
  for (int i = 0; i < 4; ++i) four[i] = extreme(eight[i], eight[i + 4]);
  return extreme(extreme(four[0], four[2]), extreme(four[1], four[3]));
}

}  // namespace

BoxBounds BoxSearch::Boxes::around_sixteen(int first) const {
  const auto low = [&](int k) {
    return extreme_of_sixteen(side[k].data() + first, [](float a, float b) { return min(a, b); });
  };
  const auto high = [&](int k) {
    return extreme_of_sixteen(side[k].data() + first, [](float a, float b) { return max(a, b); });
  };
  return {{low(0), low(1), low(2)}, {high(3), high(4), high(5)}};
}

BoxRows BoxSearch::Boxes::rows() {
  return {{side[0].data(), side[1].data(), side[2].data(), side[3].data(), side[4].data(), side[5].data()}};
}

BoxSearch::BoxSearch(const PairModel& model, const PairKernels& kernels, const ClusterLayout& layout)
    : model_(model), kernels_(kernels), layout_(layout) {}

void BoxSearch::fit_to_layout() {
  for (int kind = 0; kind < 3; ++kind) {
    const std::size_t size = layout_.elements[kind].item.size();
    for (AlignedVector<float>& row : boxes_[kind].side) row.resize(size);
    boxes_[kind].batch.resize(size / 16);
    boxes_[kind].wanted.resize(static_cast<std::size_t>(model_.clusters));
  }
}

void BoxSearch::want(const ClusterSides& sides) {
  boxes_[row_kind(sides.of_vertices)].wanted[sides.first] = 1;
  boxes_[column_kind(sides.of_vertices)].wanted[sides.second] = 1;
}

void BoxSearch::fit(Executor& executor, const ClusterMotions& motions, const PairParticles& particles) {
  executor.parallel_for("fit boxes", model_.clusters, [&](int c) {
    for (int kind = 0; kind < 3; ++kind)
      if (boxes_[kind].wanted[c] != 0) fit_cluster(kind, c, motions.mean(c), particles);
  });
  for (Boxes& boxes : boxes_) std::fill(boxes.wanted.begin(), boxes.wanted.end(), 0);
}

void BoxSearch::fit_cluster(int kind, int cluster, const Vec3f& drift, const PairParticles& particles) {
  const ClusterElements& of = layout_.elements[kind];
  Boxes& boxes = boxes_[kind];
  const int first = of.start[cluster], last = of.end(cluster);
  kernels_.fit_boxes({{of.corner[0].data(), of.corner[1].data(), of.corner[2].data()}, of.corners}, first, last,
                     particles, drift, boxes.rows());
  for (int i = first; i < last; i += 16) boxes.batch[i / 16] = boxes.around_sixteen(i);
  for (int k = 0; k < 6; ++k)  // padding boxes must overlap no other box
    std::fill(boxes.side[k].begin() + first + of.count[cluster], boxes.side[k].begin() + last, k < 3 ? 3e38f : -3e38f);
}

void BoxSearch::find(const ClusterSides& sides, const BoxBounds& far, float reach, Scratch& scratch) {
  scratch.found = 0;
  const int row = row_kind(sides.of_vertices), column = column_kind(sides.of_vertices);
  const ClusterElements &rows = layout_.elements[row], &columns = layout_.elements[column];
  Boxes &row_boxes = boxes_[row], &column_boxes = boxes_[column];
  const bool once = !sides.of_vertices && sides.first == sides.second;
  const float far_box[6] = {far.low.x, far.low.y, far.low.z, far.high.x, far.high.y, far.high.z};
  const int last = columns.end(sides.second) / 16;
  for (int sixteen = rows.start[sides.first] / 16; sixteen < rows.end(sides.first) / 16; ++sixteen) {
    const BoxBounds own = row_boxes.batch[sixteen].grown(reach);
    if (!overlap(row_boxes.batch[sixteen], far)) continue;
    scratch.batches.clear();
    for (int b = once ? sixteen : columns.start[sides.second] / 16; b < last; ++b)
      if (overlap(own, column_boxes.batch[b])) scratch.batches.push_back(b);
    if (scratch.batches.empty()) continue;
    scratch.hits.resize(std::max(scratch.hits.size(), 256 * scratch.batches.size()));
    const int count = kernels_.find_overlaps(
        {row_boxes.rows(), 16 * sixteen, reach, far_box, column_boxes.rows(), scratch.batches.data(),
         static_cast<int>(scratch.batches.size()), rows.left_out.data(), rows.left_out_start.data()},
        scratch.hits.data());
    add_pairs({rows, columns, sides.of_vertices, once}, scratch.hits.data(), count, scratch);
  }
  pad(scratch);
}

/// Appends hits without a common vertex. Keeping a hit is unpredictable, so all are written, and rejected ones
/// overwritten.
void BoxSearch::add_pairs(const Compared& of, const BoxHit* hits, int count, Scratch& scratch) {
  std::size_t kept = static_cast<std::size_t>(scratch.found);
  if (const std::size_t room = (kept + static_cast<std::size_t>(count)) / 16 + 1; scratch.blocks.size() < room)
    scratch.blocks.resize(2 * room);
  PairStencils* blocks = scratch.blocks.data();
  const auto write = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    auto& vertex = blocks[kept / 16].vertex;
    vertex[0][kept % 16] = a;
    vertex[1][kept % 16] = b;
    vertex[2][kept % 16] = c;
    vertex[3][kept % 16] = d;
  };
  const std::int32_t* row_item = of.rows.item.data();
  const std::array<const std::int32_t*, 3> corner{of.columns.corner[0].data(), of.columns.corner[1].data(),
                                                  of.columns.corner[2].data()};
  for (int k = 0; k < count; ++k) {
    const auto [i, j] = hits[k];
    const std::int32_t f0 = corner[0][j], f1 = corner[1][j];
    if (of.of_vertices) {
      const std::int32_t vertex = row_item[i], f2 = corner[2][j];
      write(vertex, f0, f1, f2);
      kept += static_cast<std::size_t>((f0 != vertex) & (f1 != vertex) & (f2 != vertex));
    } else {
      const std::int32_t e0 = of.rows.corner[0][i], e1 = of.rows.corner[1][i];
      // The edge whose vertices have the lower indices comes first. Indices of edges depend on which bodies were added
      // and removed.
      const bool swaps = (f0 < e0) | ((f0 == e0) & (f1 < e1));
      write(swaps ? f0 : e0, swaps ? f1 : e1, swaps ? e0 : f0, swaps ? e1 : f1);
      kept += static_cast<std::size_t>((!of.once | (j > i)) & (e0 != f0) & (e0 != f1) & (e1 != f0) & (e1 != f1));
    }
  }
  scratch.found = static_cast<int>(kept);
}

void BoxSearch::pad(Scratch& scratch) {
  if (scratch.found % 16 == 0) return;
  for (auto& vertex : scratch.blocks[static_cast<std::size_t>(scratch.found) / 16].vertex)
    std::fill(std::begin(vertex) + scratch.found % 16, std::end(vertex), vertex[0]);
}

}  // namespace pliant
