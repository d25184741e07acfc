// Which vertices may meet which triangles, and which edges which edges, while everything moves from one place to another.
//
// Boxes hold each vertex's whole motion, grown by half the radius, and so do those of edges and triangles, which are the boxes of
// their vertices together. Vertices are looked for in a hierarchy over the triangles, edges in one over the edges, in packets of
// eight that lie together: one way down a tree for eight, then eight boxes at once. (Going by pairs of triangles and what each
// of them owns was tried, is more code and was no faster: docs/internals/broadphase.md.) Each packet's lists are written by one thread:
// counts, then places, then the lists. Sorted, and the same on any number of threads.
//
// Memory grows with what is found and is kept: a frame that finds no more than an earlier one allocates nothing.
#pragma once

#include <vector>

#include "collision/broad/tree.h"
#include "collision/proxies/contact_elements.h"
#include "parallel/executor.h"

namespace pliant {

class CandidateFinder {
 public:
  explicit CandidateFinder(ContactElements elements);

  /// Finds all pairs that may come within `radius` [m] while vertices move straight from `from` to `to`. All finite and below
  /// 1e15 m. `anew` builds the trees from scratch, as the first call does in any case: due when things have moved far.
  void find(Executor& executor, const std::vector<Vec3f>& from, const std::vector<Vec3f>& to, float radius,
            bool anew = false);

  /// For each vertex the triangles of which it is no corner, ascending.
  const IntLists& vertex_triangles() const { return vertex_triangles_; }
  /// For each edge the edges after it in ContactElements::edges with which it shares no vertex, ascending.
  const IntLists& edge_edges() const { return edge_edges_; }
  const ContactElements& elements() const { return elements_; }

 private:
  /// What one thread found for some packets: runs of items, each with its owner.
  struct Part {
    struct Run {
      int owner, count;
    };
    std::vector<Run> runs;
    std::vector<int> items, packs, hits;
  };

  void fit_boxes(Executor& executor, const std::vector<Vec3f>& from, const std::vector<Vec3f>& to, float radius);
  void fit_trees(Executor& executor, bool anew);
  template <class Wanted>
  void find_lists(Executor& executor, const Tree<BoxBounds>& owners, const Tree<BoxBounds>& others,
                  const int* owner_of_leaf, IntLists& lists, const Wanted& wanted);

  ContactElements elements_;
  std::vector<BoxBounds> all_vertex_boxes_, vertex_boxes_, edge_boxes_, triangle_boxes_;
  Tree<BoxBounds> vertex_tree_, edge_tree_, triangle_tree_;
  bool built_ = false;
  std::vector<Part> parts_;
  IntLists vertex_triangles_, edge_edges_;
};

}  // namespace pliant
