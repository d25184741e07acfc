// Draws apart what passes through one another at the beginning.
//
// A surface that is cut in pieces by another has a piece on the wrong side: the smaller one. It is drawn back along the normals of
// what cuts it, at a capped speed that never becomes momentum; until it is through, contact between the two leaves it out. A
// vertex inside a closed body that nothing pushes goes to the closest point of its surface instead. A slit, which
// separates nothing, is left as it is: which side would be the right one?
#pragma once

#include <memory>
#include <vector>

#include "collision/intersections.h"
#include "collision/mesh_query.h"
#include "model/substep.h"

namespace pliant {

struct PairModel;

class Untangler {
 public:
  explicit Untangler(const PairModel& model);

  /// Finds out what is on a wrong side, from the tangles of the same positions.
  void begin_frame(const Record* positions, const std::vector<Intersection>& tangles);

  bool is_busy() const { return !pushes_.empty(); }
  /// Vertices inside closed bodies.
  std::int64_t inside() const { return inside_; }
  /// Whether a vertex is lost in a body: contact between the two is left out.
  bool is_lost(int vertex, int body) const {
    return !lost_in_.empty() && lost_in_[static_cast<std::size_t>(vertex)] == body;
  }

  /// In place of what was predicted, lost vertices go at most `distance` [m] towards where they belong. What they go counts as
  /// done before the substep, so that it makes no speed.
  void push(float distance, Record* displacements, Record* remainders);

 private:
  struct Push {
    int vertex;
    Vec3f direction;
    float remaining;  ///< [m]
  };
  struct Closed {
    int body, first;  ///< particle
    std::unique_ptr<MeshQuery> query;
  };

  void find_inside(const Record* positions);
  void find_pieces(const Record* positions, const std::vector<Intersection>& tangles);
  void draw_back(const Record* positions, const std::vector<Intersection>& cuts, int body, int through);
  void add(int vertex, int body, const Push& push);

  const PairModel& model_;
  std::vector<Closed> closed_;
  std::vector<int> lost_in_;  ///< of each vertex, -1: in none; empty: of all
  std::vector<Push> pushes_;
  std::int64_t inside_ = 0;
};

}  // namespace pliant
