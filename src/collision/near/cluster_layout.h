// The primitives of each cluster in SIMD layout, made once for each body.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/proxies/pair_kernels.h"
#include "collision/proxies/pair_model.h"

namespace pliant {

enum ElementKind { vertex_kind, edge_kind, triangle_kind };

/// Primitives of one kind by cluster, along a Morton curve, padded to a multiple of sixteen by repeating the last.
struct ClusterElements {
  int corners = 0;
  std::vector<int> start, count;  ///< for each cluster
  std::vector<std::int32_t> item;
  std::array<std::vector<std::int32_t>, 3> corner;
  /// For each row of a comparison: the columns to exclude, which share a vertex or are static neighbours.
  std::vector<std::int32_t> left_out_start;
  std::vector<LeftOut> left_out;
  BodyBlocks row_blocks, left_out_blocks;  ///< each body's part of `item` and of `left_out`

  /// One past the last padded entry of a cluster.
  int end(int cluster) const { return start[cluster] + (count[cluster] + 15) / 16 * 16; }
};

struct ClusterLayout {
  std::array<ClusterElements, 3> elements;  ///< by ElementKind
  /// For each cluster: its vertices and the corners of primitives that begin at them, padded to multiples of sixteen.
  std::vector<std::int32_t> vertices;
  std::vector<int> vertex_start, vertex_count;
  BodyBlocks vertex_blocks;

  ClusterLayout();
  /// Lays out the clusters of a body. Leaves `left_out` empty; add_static_pairs fills it.
  void add(const PairModel& model, int body);
  /// Removes a body, which had these `clusters`.
  void remove(int body, const Block& clusters);
};

/// Rows of a comparison are vertices or edges, columns triangles or edges.
inline ElementKind row_kind(bool of_vertices) { return of_vertices ? vertex_kind : edge_kind; }
inline ElementKind column_kind(bool of_vertices) { return of_vertices ? triangle_kind : edge_kind; }

}  // namespace pliant
