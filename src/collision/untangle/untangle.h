// Draws apart what passes through one another at the beginning.
//
// A *part* is a connected component of an object's surface, or a whole mesh collider: two skirts in one file are two parts.
// A part that is cut in pieces by another, or by itself, has a piece on the wrong side: the smaller one. It is drawn back along the normals of
// what cuts it; until it is through, contact between the two leaves it out. What is inside a closed body that nothing pushes goes to
// the closest point of its surface instead, or, where a sheet passes through the body's middle, all of it the shorter way square
// to the sheet: closest points would tear it to all sides. A slit, which separates nothing, is left as it is: which side would be
// the right one? Where drawing pieces back would make more intersections between two parts, nothing is drawn between them.
//
// All at a capped speed that never becomes momentum: nor does what the links of a stretched surface make of it (calm).
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "collision/fields/mesh_query.h"
#include "collision/proxies/contact_elements.h"
#include "collision/proxies/pair_model.h"
#include "collision/untangle/intersections.h"
#include "model/substep.h"
#include "parallel/executor.h"

namespace pliant {

class Untangler {
 public:
  explicit Untangler(const PairModel& model);

  /// Finds out what is on a wrong side, from the tangles of the same positions.
  void begin_frame(const Record* positions, const std::vector<Intersection>& tangles);

  bool is_busy() const { return !pushes_.empty(); }
  /// Whether anything is kept from being faster than it may: what is drawn, and what a closed body that nothing pushes still cuts.
  bool calms() const { return !speeds_.empty(); }
  /// Vertices inside closed bodies.
  std::int64_t inside() const { return inside_; }
  /// Whether one side of a pair is on the wrong side of the other's part: contact leaves the pair out. A piece keeps contact with itself.
  bool is_lost(const PairStencil& pair) const;
  /// Whether anything of the two parts that intersect is being drawn apart.
  bool draws(const Intersection& tangle) const;

  /// In place of what was predicted, lost vertices go at most `distance` [m] towards where they belong. What they go counts as
  /// done before the substep, so that it makes no speed. Due before anything else changes what is predicted.
  void push(float distance, float h, Record* displacements, Record* remainders);

  /// After a substep: nothing of a part that is being drawn is faster than `cap` [m/s] but what was so before it, and nothing that is lost.
  /// `missing` is what velocities of a body lack.
  void calm(float cap, Record* velocities, FunctionRef<Vec3f(int body)> missing) const;

 private:
  struct Push {
    int vertex;
    Vec3f direction;
    float remaining;  ///< [m]
  };
  /// What goes back through a part, if that makes no more intersections.
  struct Candidate {
    Push push;
    int through, piece;
  };
  /// Lost in one closed body, and joined by edges.
  using Patch = std::vector<int>;
  using PartPair = std::pair<int, int>;

  struct Closed {
    int body, part, first;  ///< first: a particle
    std::unique_ptr<MeshQuery> query;
  };

  void find_inside(const Record* positions);
  std::vector<Patch> patches_of(const std::vector<int>& vertices) const;
  void lead_out(const Patch& patch, const Closed& closed, const Record* positions);
  float thickness_of(int vertex, int body) const;
  void find_parts();
  int part_of(int vertex) const { return part_[static_cast<std::size_t>(vertex)]; }
  int body_of(int vertex) const { return model_.vertex_body[static_cast<std::size_t>(vertex)]; }
  PartPair parts_of(const Intersection& tangle) const;
  bool is_closed(int part) const;
  bool is_drawn(int part) const { return !drawn_.empty() && drawn_[static_cast<std::size_t>(part)] != 0; }
  void mark_drawn(int vertex);
  Vec3f mean_normal(const Patch& patch, const Record* positions) const;
  void find_pieces(const Record* positions, const std::vector<Intersection>& tangles);
  void draw_back(const Record* positions, const std::vector<Intersection>& cuts, int part, int through);
  std::vector<PartPair> made_worse(const Record* positions, const std::vector<Intersection>& tangles);
  void add(int part, int piece, const Push& push);

  const PairModel& model_;
  IntersectionFinder finder_;
  std::vector<int> part_;  ///< of each vertex
  int parts_ = 0;
  std::vector<Closed> closed_;
  IntLists around_;           ///< of each vertex the triangles at it, ascending; empty: no body is closed
  std::vector<int> lost_in_;  ///< the part that each vertex is lost in, -1: in none; empty: of all
  std::vector<int> piece_;    ///< of each vertex that is lost, a number of its piece; as long as lost_in_
  std::vector<Candidate> candidates_;
  std::vector<Push> pushes_;
  std::vector<char> drawn_;                    ///< parts of which something is lost or cut by a closed body; empty: none
  std::vector<std::pair<int, float>> speeds_;  ///< of all vertices of parts that are drawn, as predicted [m/s]
  std::int64_t inside_ = 0;
};

}  // namespace pliant
