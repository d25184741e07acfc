// Leads apart what intersects initially.
//
// A part (parts.h) that is cut in pieces by another, or by itself, has a piece on the wrong side: the smaller one. That piece moves back along the
// normals of what cuts it. Until it is through, it has no contact with the part that cuts it. A vertex inside a closed static or kinematic
// body moves to the closest point of its surface. Where a sheet passes through the middle of the body, all of it moves the shorter way
// along its mean normal: closest points would tear it to all sides. A slit separates nothing and is left as it is.
//
// Before each frame the moves are tried on positions alone. Where they would make more intersections between two parts, nothing
// moves between the two in that frame.
//
// Displacements have a speed limit and never become momentum, nor does what constraints of a stretched surface make of them.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "collision/fields/mesh_query.h"
#include "collision/proxies/contact_elements.h"
#include "collision/proxies/pair_model.h"
#include "collision/untangle/intersections.h"
#include "collision/untangle/parts.h"
#include "model/substep.h"
#include "parallel/executor.h"

namespace pliant {

class Untangler {
 public:
  explicit Untangler(const PairModel& model);

  /// Finds what is on a wrong side, from the intersections of the same positions.
  void begin_frame(const Record* positions, const std::vector<Intersection>& found);

  bool is_busy() const { return !pushes_.empty(); }
  /// True while the untangling speed limit is active: something is led apart, or a closed static or kinematic body still cuts it.
  bool limits_speeds() const { return !speeds_.empty(); }
  /// Vertices inside closed bodies.
  std::int64_t inside() const { return inside_; }
  /// Whether one side of a pair is on the wrong side of the other's part, so that the pair has no contact. A piece keeps contact with
  /// itself.
  bool is_exempt(const PairStencil& pair) const;
  /// Whether anything of the two parts that intersect is being led apart.
  bool leads_apart(const Intersection& found) const;

  /// Vertices on a wrong side move at most `distance` [m] towards where they belong, in place of what was predicted. The move goes into the
  /// remainders, so that it makes no velocity. Due before anything else changes what is predicted.
  void push(float distance, float h, Record* displacements, Record* remainders);

  /// After a substep: limits the speed of each vertex of parts that are led apart to `limit` [m/s], or to its predicted speed where that
  /// is larger and the vertex is on no wrong side. `missing` is what velocities of a body lack.
  void limit_speeds(float limit, Record* velocities, FunctionRef<Vec3f(int body)> missing) const;

 private:
  struct Push {
    int vertex;
    Vec3f direction;
    float remaining;  ///< [m]
  };
  /// A vertex that moves back through a part, if that makes no more intersections.
  struct Candidate {
    Push push;
    int through, piece;
  };
  using PartPair = std::pair<int, int>;

  struct Closed {
    int body, part, first;  ///< first: a particle
    std::unique_ptr<MeshQuery> query;
  };

  void find_inside(const Record* positions);
  void lead_out(const std::vector<int>& patch, const Closed& closed, const Record* positions);
  int part_of(int vertex) const { return parts_.of[static_cast<std::size_t>(vertex)]; }
  int body_of(int vertex) const { return model_.vertex_body[static_cast<std::size_t>(vertex)]; }
  PartPair parts_of(const Intersection& found) const;
  bool is_closed(int part) const;
  bool is_led(int part) const { return !led_.empty() && led_[static_cast<std::size_t>(part)] != 0; }
  void mark_led(int vertex);
  void find_pieces(const Record* positions, const std::vector<Intersection>& found);
  void lead_back(const Record* positions, const std::vector<Intersection>& cuts, PartPair parts,
                 std::vector<Candidate>& out) const;
  std::vector<PartPair> made_worse(const Record* positions, const std::vector<Intersection>& found,
                                   const std::vector<Candidate>& candidates);
  void add(int part, int piece, const Push& push);

  const PairModel& model_;
  IntersectionFinder finder_;
  Parts parts_;
  std::vector<Closed> closed_;
  IntLists around_;                 ///< of each vertex the triangles at it, ascending; empty: no body is closed
  std::vector<int> wrong_side_of_;  ///< of each vertex the part, -1: none; empty: none of all
  std::vector<int> piece_;          ///< of each vertex on a wrong side, a number of its piece; as long as wrong_side_of_
  std::vector<Push> pushes_;
  std::vector<char> led_;                      ///< parts whose speed is limited; empty: none
  std::vector<std::pair<int, float>> speeds_;  ///< predicted speeds of all vertices of those parts [m/s]
  std::int64_t inside_ = 0;
};

}  // namespace pliant
