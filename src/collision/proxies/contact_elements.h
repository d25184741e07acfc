// The contact primitives of surfaces and lines: vertices, edges and triangles.
#pragma once

#include <array>
#include <vector>

#include "topology/edges.h"

namespace pliant {

/// One list of ints for each owner, in compressed rows: owner i has items[start[i]] to items[start[i + 1] - 1].
struct IntLists {
  std::vector<int> start, items;

  const int* begin(int i) const { return items.data() + start[static_cast<std::size_t>(i)]; }
  const int* end(int i) const { return items.data() + start[static_cast<std::size_t>(i) + 1]; }
};

/// The primitives of surfaces and lines between which contacts are found.
struct ContactElements {
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> edges;  ///< triangle edges and loose edges: a < b, ascending, unique
  std::vector<int> vertices;              ///< vertices of all primitives and loose vertices, ascending, unique
  int vertex_count = 0;                   ///< total, including vertices without contact
};

/// Collects primitives: triangles, loose edges (ropes) and loose vertices (free
/// particles). Throws an Error if an index is outside 0..vertex_count - 1.
ContactElements make_contact_elements(const std::vector<Triangle>& triangles,
                                      const std::vector<std::array<int, 2>>& loose_edges,
                                      const std::vector<int>& loose_vertices, int vertex_count);

}  // namespace pliant
