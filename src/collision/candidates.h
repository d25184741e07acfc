// Which vertices may meet which triangles, and which edges which edges, while everything moves from one place to another.
//
// Both come from one question: which elements (triangles, loose edges, loose vertices) overlap as boxes that hold their whole
// motion, grown by half the radius each. Every vertex and every edge has one owner, an element that it is part of; what an
// overlapping pair of elements owns is then tested box against box. An owner's box holds what it owns, so nothing is missed;
// an owner is one, so nothing comes twice. Elements are handled in packets of the tree's order, each by one thread that alone
// writes what its elements own: counts, then places, then the lists. Sorted, and the same on any number of threads.
//
// Memory grows with what is found and is kept: a frame that finds no more than an earlier one allocates nothing.
#pragma once

#include <array>
#include <vector>

#include "collision/tree.h"
#include "parallel/executor.h"
#include "topology/edges.h"

namespace pliant {

/// Lists of ints, one for each owner: those of i are items[start[i]] to items[start[i + 1] - 1].
struct IntLists {
  std::vector<int> start, items;

  const int* begin(int i) const { return items.data() + start[static_cast<std::size_t>(i)]; }
  const int* end(int i) const { return items.data() + start[static_cast<std::size_t>(i) + 1]; }
};

/// Surfaces and lines, as candidates are looked for among them.
struct ContactElements {
  /// Edges of the triangles and loose ones, ascending, each once.
  std::vector<std::array<int, 2>> edges;
  std::vector<Triangle> triangles;
  int vertex_count = 0;

  struct Element {
    std::array<int, 3> corners;         ///< the last repeated where there are fewer
    std::array<int, 3> owned_vertices;  ///< -1 where there are fewer
    std::array<int, 3> owned_edges;     ///< -1 where there are fewer
  };
  std::vector<Element> elements;  ///< triangles first, then loose edges, then loose vertices
};

/// Every vertex not in a triangle or loose edge is a loose vertex where `loose_vertices` lists it, else it meets nothing. Throws Error
/// where an index is outside 0..vertex_count - 1.
ContactElements make_contact_elements(const std::vector<Triangle>& triangles,
                                      const std::vector<std::array<int, 2>>& loose_edges,
                                      const std::vector<int>& loose_vertices, int vertex_count);

class CandidateFinder {
 public:
  explicit CandidateFinder(ContactElements elements);

  /// Finds all pairs that may come within `radius` [m] while vertices move straight from `from` to `to`. All finite and below
  /// 1e15 m. `anew` builds the tree from scratch, as the first call does in any case: due when things have moved far.
  void find(Executor& executor, const std::vector<Vec3f>& from, const std::vector<Vec3f>& to, float radius,
            bool anew = false);

  /// For each vertex the triangles of which it is no corner, ascending.
  const IntLists& vertex_triangles() const { return vertex_triangles_; }
  /// For each edge the edges after it in ContactElements::edges with which it shares no vertex, ascending.
  const IntLists& edge_edges() const { return edge_edges_; }
  const ContactElements& elements() const { return elements_; }

 private:
  /// What one thread found for the elements of some packets.
  struct Part {
    struct Run {
      int owner, count;
    };
    std::vector<Run> vertex_runs, edge_runs;
    std::vector<int> triangles, edges, slots, others;
  };

  void fit_boxes(Executor& executor, const std::vector<Vec3f>& from, const std::vector<Vec3f>& to, float radius);
  void find_part(int part);
  void add_vertex_triangles(int vertex, Part& part);
  void add_edge_edges(int edge, Part& part);
  BoxBounds edge_box(int edge) const;
  void gather(Executor& executor);

  ContactElements elements_;
  std::vector<BoxBounds> vertex_boxes_, boxes_;
  Tree<BoxBounds> tree_;
  bool built_ = false;
  std::vector<Part> parts_;
  IntLists vertex_triangles_, edge_edges_;
};

}  // namespace pliant
