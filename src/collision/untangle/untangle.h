// Moves initially intersecting surfaces apart.
//
// A part (parts.h) that another part, or itself, cuts into pieces has its smaller piece on the wrong side. That piece moves
// back along the normals of the other part and has no contact with it until it is through. A vertex inside a closed static
// or kinematic body moves to the closest surface point. A sheet through the middle of a body moves the shorter way along
// its mean normal, because closest points would tear it apart. Slits separate nothing and are ignored.
//
// Before each frame the moves are tried on positions alone. If they would create more intersections between two parts,
// nothing moves between the two in that frame.
//
// Moves are limited in speed and add no momentum; neither do the constraint forces that they cause.
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

/// Over thirty members: the steps of one algorithm that share its scratch.
class Untangler {
 public:
  explicit Untangler(const PairModel& model);

  /// Finds what is on the wrong side, from the intersections at the same positions.
  void begin_frame(const Record* positions, const std::vector<Intersection>& found);

  bool is_busy() const { return !pushes_.empty(); }
  /// True while untangling limits speeds: a cut-off part of a surface moves back, or a closed body still intersects a surface.
  bool limits_speeds() const { return !speeds_.empty(); }
  /// The number of vertices inside closed bodies.
  std::int64_t inside() const { return inside_; }
  /// True if one side of a pair is on the wrong side of the other's part,
  /// so that the pair has no contact. A piece keeps its self-contact.
  bool is_exempt(const PairStencil& pair) const;
  /// True if either of the two intersecting parts is being moved.
  bool leads_apart(const Intersection& found) const;

  /// Moves vertices on the wrong side by at most `distance` [m] towards their target, in place of the prediction. The move
  /// goes into the rounding residues, so it adds no velocity. Call it before anything else changes the prediction.
  void push(float distance, float h, Record* displacements, Record* remainders);

  /// After a substep: limits the speed of vertices of moving parts to `limit` [m/s], or to a higher predicted speed if they
  /// are not on a wrong side. `missing` is the gravity not yet included in a body's velocities.
  void limit_speeds(float limit, Record* velocities, FunctionRef<Vec3f(int body)> missing) const;

 private:
  struct Push {
    int vertex;
    Vec3f direction;
    float remaining;  ///< [m]
  };
  /// A vertex that moves back through a part, unless that creates more intersections.
  struct Candidate {
    Push push;
    int through, piece;
  };
  using PartPair = std::pair<int, int>;

  struct Closed {
    int body, part, first;  ///< first particle
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
  std::vector<int> wrong_side_of_;  ///< for each vertex the part, or -1; empty: none at all
  std::vector<int> piece_;          ///< for each vertex on a wrong side, the index of its piece; as long as wrong_side_of_
  std::vector<Push> pushes_;
  std::vector<char> led_;                      ///< parts with a speed limit; empty: none
  std::vector<std::pair<int, float>> speeds_;  ///< predicted speed of each vertex of parts with a speed limit [m/s]
  std::int64_t inside_ = 0;
};

}  // namespace pliant
