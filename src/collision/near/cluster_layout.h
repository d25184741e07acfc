// The elements of each cluster, laid out for sixteen lanes. Made once for a model.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/proxies/pair_kernels.h"
#include "collision/proxies/pair_model.h"

namespace pliant {

enum ElementKind { vertex_kind, edge_kind, triangle_kind };

/// Elements of one kind by cluster: each cluster's along a Morton curve, padded to a multiple of sixteen by repeating the last.
struct ClusterElements {
  int corners = 0;
  std::vector<int> start, count;  ///< of each cluster; `start` has one more
  std::vector<std::int32_t> item;
  std::array<std::vector<std::int32_t>, 3> corner;
  /// Of each row of a comparison: columns to leave out, because they share a vertex with it or are static neighbours.
  std::vector<std::int32_t> left_out_start;
  std::vector<LeftOut> left_out;
};

struct ClusterLayout {
  std::array<ClusterElements, 3> elements;  ///< by ElementKind
  /// Of each cluster its vertices and the corners of all elements that begin at them, padded to multiples of sixteen.
  std::vector<std::int32_t> vertices;
  std::vector<int> vertex_start;
};

/// `left_out` stays empty: find_static_pairs fills it.
ClusterLayout lay_out_clusters(const PairModel& model);

/// The rows of a comparison between a vertex and triangles, or between edges; and its columns.
inline ElementKind row_kind(bool of_vertices) { return of_vertices ? vertex_kind : edge_kind; }
inline ElementKind column_kind(bool of_vertices) { return of_vertices ? triangle_kind : edge_kind; }

}  // namespace pliant
