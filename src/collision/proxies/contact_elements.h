// The contact primitives of surfaces and lines: vertices, edges and triangles.
#pragma once

#include <array>
#include <vector>

#include "topology/edges.h"

namespace pliant {

/// Several lists of ints in compressed rows: list i consists of items[start[i]] to items[start[i + 1] - 1].
struct IntLists {
  std::vector<int> start, items;

  const int* begin(int i) const { return items.data() + start[static_cast<std::size_t>(i)]; }
  const int* end(int i) const { return items.data() + start[static_cast<std::size_t>(i) + 1]; }
};

/// The primitives among which contacts are found.
struct ContactElements {
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> edges;  ///< edges of triangles and loose edges, as vertices a < b; ascending, unique
  std::vector<int> vertices;              ///< vertices of all primitives and loose vertices, ascending, unique
  int vertex_count = 0;                   ///< number of all vertices, including those without contact
};

/// Collects primitives: triangles, loose edges (ropes) and loose vertices (free
/// particles). Throws an Error if an index is outside 0..vertex_count - 1.
ContactElements make_contact_elements(const std::vector<Triangle>& triangles,
                                      const std::vector<std::array<int, 2>>& loose_edges,
                                      const std::vector<int>& loose_vertices, int vertex_count);

}  // namespace pliant
