// Surfaces and lines as what may touch: vertices, edges and triangles.
#pragma once

#include <array>
#include <vector>

#include "topology/edges.h"

namespace pliant {

/// Lists of ints, one for each owner: those of i are items[start[i]] to items[start[i + 1] - 1].
struct IntLists {
  std::vector<int> start, items;

  const int* begin(int i) const { return items.data() + start[static_cast<std::size_t>(i)]; }
  const int* end(int i) const { return items.data() + start[static_cast<std::size_t>(i) + 1]; }
};

/// The elements of surfaces and lines that contact is found between.
struct ContactElements {
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> edges;  ///< of the triangles and loose ones: a < b, ascending, each once
  std::vector<int> vertices;              ///< of all these and loose ones, ascending, each once
  int vertex_count = 0;                   ///< of all there are
};

/// What may touch: triangles, edges of no triangle (ropes), and vertices of neither (grains). Throws Error where an index is outside
/// 0..vertex_count - 1.
ContactElements make_contact_elements(const std::vector<Triangle>& triangles,
                                      const std::vector<std::array<int, 2>>& loose_edges,
                                      const std::vector<int>& loose_vertices, int vertex_count);

}  // namespace pliant
