// Finds the vertex-triangle and edge-edge pairs that can come near in a substep in which all vertices move linearly.
//
// Each vertex has a swept box, grown by half the radius; edges and triangles have the union of their vertices' boxes.
// Vertices are searched in a BVH of triangles, edges in a BVH of edges, in packets of eight neighbours: one descent for
// eight, then eight boxes at once. (Enumerating pairs of triangles and their owned primitives was no faster, with more
// code: docs/internals/broadphase.md.) One thread writes each packet's lists: counts, then offsets, then lists. They
// are sorted and do not depend on the number of threads.
//
// Memory grows with the result and is reused: a frame with no more candidates than before allocates nothing.
#pragma once

#include <vector>

#include "collision/broad/tree.h"
#include "collision/proxies/contact_elements.h"
#include "parallel/executor.h"

namespace pliant {

class CandidateFinder {
 public:
  explicit CandidateFinder(ContactElements elements);

  /// Finds all pairs that can come within `radius` [m] while vertices move linearly from `from` to `to`. All positions
  /// must be finite and below 1e15 m. `rebuild` builds new trees, as the first call does; use it after large motions.
  void find(Executor& executor, const std::vector<Vec3f>& from, const std::vector<Vec3f>& to, float radius,
            bool rebuild = false);

  /// For each vertex, the triangles near it that do not contain it, ascending.
  const IntLists& vertex_triangles() const { return vertex_triangles_; }
  /// For each edge, the edges near it with a higher index and no common vertex, ascending.
  const IntLists& edge_edges() const { return edge_edges_; }
  const ContactElements& elements() const { return elements_; }

 private:
  /// What one thread found for some packets: lists of items, each with its owner.
  struct Part {
    struct Run {
      int owner, count;
    };
    std::vector<Run> runs;
    std::vector<int> items, packs, hits;
  };

  void fit_boxes(Executor& executor, const std::vector<Vec3f>& from, const std::vector<Vec3f>& to, float radius);
  void fit_trees(Executor& executor, bool rebuild);
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
