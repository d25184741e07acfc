// Draws apart what passes through one another at the beginning.
//
// A surface that is cut in pieces by another has a piece on the wrong side: the smaller one. It is drawn back along the normals of
// what cuts it; until it is through, contact between the two leaves it out. What is inside a closed body that nothing pushes goes to
// the closest point of its surface instead, or, where a sheet passes through the body's middle, all of it the shorter way square
// to the sheet: closest points would tear it to all sides. A slit, which separates nothing, is left as it is: which side would be
// the right one?
//
// All at a capped speed that never becomes momentum: nor does what the links of a stretched surface make of it (calm).
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "collision/fields/mesh_query.h"
#include "collision/proxies/contact_elements.h"
#include "collision/untangle/intersections.h"
#include "model/substep.h"
#include "parallel/executor.h"

namespace pliant {

struct PairModel;

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
  /// Whether a vertex is lost in a body: contact between the two is left out.
  bool is_lost(int vertex, int body) const {
    return !lost_in_.empty() && lost_in_[static_cast<std::size_t>(vertex)] == body;
  }

  /// Whether anything of a body is being drawn out of another, or of itself.
  bool draws(int body, int out_of) const;

  /// In place of what was predicted, lost vertices go at most `distance` [m] towards where they belong. What they go counts as
  /// done before the substep, so that it makes no speed. Due before anything else changes what is predicted.
  void push(float distance, float h, Record* displacements, Record* remainders);

  /// After a substep: nothing of a body that is being drawn is faster than `cap` [m/s] but what was so before it, and nothing that is lost.
  /// `missing` is what velocities of a body lack.
  void calm(float cap, Record* velocities, FunctionRef<Vec3f(int body)> missing) const;

 private:
  struct Push {
    int vertex;
    Vec3f direction;
    float remaining;  ///< [m]
  };
  /// Lost in one closed body, and joined by edges.
  using Patch = std::vector<int>;

  struct Closed {
    int body, first;  ///< particle
    std::unique_ptr<MeshQuery> query;
  };

  void find_inside(const Record* positions);
  std::vector<Patch> patches_of(const std::vector<int>& vertices) const;
  void lead_out(const Patch& patch, const Closed& closed, const Record* positions);
  float thickness_of(int vertex, int body) const;
  bool is_closed(int body) const;
  bool is_drawn(int body) const { return !drawn_.empty() && drawn_[static_cast<std::size_t>(body)] != 0; }
  void mark_drawn(int vertex);
  Vec3f mean_normal(const Patch& patch, const Record* positions) const;
  void find_pieces(const Record* positions, const std::vector<Intersection>& tangles);
  void draw_back(const Record* positions, const std::vector<Intersection>& cuts, int body, int through);
  void add(int vertex, int body, const Push& push);

  const PairModel& model_;
  std::vector<Closed> closed_;
  IntLists around_;           ///< of each vertex the triangles at it, ascending; empty: no body is closed
  std::vector<int> lost_in_;  ///< of each vertex, -1: in none; empty: of all
  std::vector<Push> pushes_;
  std::vector<char> drawn_;                    ///< bodies of which something is lost or cut by a closed body; empty: none
  std::vector<std::pair<int, float>> speeds_;  ///< of all vertices of bodies that are drawn, as predicted [m/s]
  std::int64_t inside_ = 0;
};

}  // namespace pliant
