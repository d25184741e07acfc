// The primitives of each cluster in SIMD layout, computed once for each body.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/proxies/pair_kernels.h"
#include "collision/proxies/pair_model.h"

namespace pliant {

enum ElementKind { vertex_kind, edge_kind, triangle_kind };

/// Primitives of one kind, by cluster and along a Morton curve; each cluster is padded to a multiple of sixteen.
struct ClusterElements {
  int corners = 0;
  std::vector<int> start, count;  ///< index of each cluster's first entry, and number of its entries without padding
  std::vector<std::int32_t> item;
  std::array<std::vector<std::int32_t>, 3> corner;
  /// For each row of a comparison: the columns to exclude, because they share a vertex or are static neighbours.
  std::vector<std::int32_t> left_out_start;
  std::vector<LeftOut> left_out;
  BodyBlocks row_blocks, left_out_blocks;  ///< for each body, its block of `item` and of `left_out`

  /// Index one past a cluster's last padded entry.
  int end(int cluster) const { return start[cluster] + (count[cluster] + 15) / 16 * 16; }
};

struct ClusterLayout {
  std::array<ClusterElements, 3> elements;  ///< indexed by ElementKind
  /// For each cluster: its vertices and the corners of primitives that begin at them, padded to multiples of sixteen.
  std::vector<std::int32_t> vertices;
  std::vector<int> vertex_start, vertex_count;
  BodyBlocks vertex_blocks;

  ClusterLayout();
  /// Adds the clusters of a body. Its excluded columns stay empty until add_static_pairs fills them.
  void add(const PairModel& model, int body);
  /// Removes a body whose clusters were `clusters`.
  void remove(int body, const Block& clusters);
};

/// The kind of the rows of a comparison: vertices (compared with triangles) or edges (compared with edges).
inline ElementKind row_kind(bool of_vertices) { return of_vertices ? vertex_kind : edge_kind; }
inline ElementKind column_kind(bool of_vertices) { return of_vertices ? triangle_kind : edge_kind; }

}  // namespace pliant
