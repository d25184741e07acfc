#include "collision/near/box_search.h"

#include <algorithm>

namespace pliant {

BoxBounds BoxSearch::Boxes::at(int i) const {
  return {{side[0][i], side[1][i], side[2][i]}, {side[3][i], side[4][i], side[5][i]}};
}

BoxRows BoxSearch::Boxes::rows() {
  return {{side[0].data(), side[1].data(), side[2].data(), side[3].data(), side[4].data(), side[5].data()}};
}

BoxSearch::BoxSearch(const PairModel& model, const PairKernels& kernels, const ClusterLayout& layout)
    : model_(model), kernels_(kernels), layout_(layout) {}

void BoxSearch::fit_to_layout() {
  for (int kind = 0; kind < 3; ++kind) {
    const std::size_t size = layout_.elements[kind].item.size();
    for (std::vector<float>& row : boxes_[kind].side) row.resize(size);
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
      if (boxes_[kind].wanted[c] != 0) fit_cluster(kind, c, motions.mean(), particles);
  });
  for (Boxes& boxes : boxes_) std::fill(boxes.wanted.begin(), boxes.wanted.end(), 0);
}

void BoxSearch::fit_cluster(int kind, int cluster, const Vec3f& drift, const PairParticles& particles) {
  const ClusterElements& of = layout_.elements[kind];
  Boxes& boxes = boxes_[kind];
  const int first = of.start[cluster], last = of.end(cluster);
  kernels_.fit_boxes({{of.corner[0].data(), of.corner[1].data(), of.corner[2].data()}, of.corners}, first, last, particles,
                     drift, boxes.rows());
  for (int i = first; i < last; i += 16) {
    BoxBounds all = boxes.at(i);
    for (int k = i + 1; k < i + 16; ++k) all = {min(all.low, boxes.at(k).low), max(all.high, boxes.at(k).high)};
    boxes.batch[i / 16] = all;
  }
  for (int k = 0; k < 6; ++k)  // padding boxes overlap nothing
    std::fill(boxes.side[k].begin() + first + of.count[cluster], boxes.side[k].begin() + last, k < 3 ? 3e38f : -3e38f);
}

void BoxSearch::find(const ClusterSides& sides, const BoxBounds& far, float reach, Scratch& scratch) {
  scratch.found.clear();
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
    const int count =
        kernels_.find_overlaps({row_boxes.rows(), 16 * sixteen, reach, far_box, column_boxes.rows(), scratch.batches.data(),
                                static_cast<int>(scratch.batches.size()), rows.left_out.data(), rows.left_out_start.data()},
                               scratch.hits.data());
    for (int k = 0; k < count; ++k)
      if (const auto [i, j] = scratch.hits[k]; !once || j > i)
        add_pair(sides.of_vertices, rows.item[i], columns.item[j], scratch.found);
  }
}

/// Skips pairs with a common vertex.
void BoxSearch::add_pair(bool of_vertices, std::int32_t a, std::int32_t b, std::vector<NearPair>& found) const {
  const ContactElements& all = model_.elements;
  if (of_vertices) {
    const Triangle& t = all.triangles[b];
    if (t[0] == a || t[1] == a || t[2] == a) return;
  } else {
    const auto &e = all.edges[a], &f = all.edges[b];
    if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return;
    if (f < e) std::swap(a, b);  // the lower corners first: numbers say nothing where bodies came and went
  }
  found.push_back({stencil_of(all, of_vertices, a, b).vertex, -1});
}

}  // namespace pliant
