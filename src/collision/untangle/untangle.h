// Moves initially intersecting surfaces apart.
//
// A part (parts.h) that is cut into pieces, by another part or by itself, has its smaller piece on the wrong side. That
// piece moves back along the normals of the part that cuts it and has no contact with that part until it is through. A
// vertex inside a closed static or kinematic body moves to the closest surface point. Where a sheet passes through the
// middle of a body, closest points would tear it apart, so it moves along its mean normal, the shorter way. Slits cut
// no piece off; they are ignored.
//
// Before each frame the moves are tried on positions alone. If they would create more intersections between two parts,
// nothing moves between these two in that frame. Moves are limited in speed and add no momentum; nor do the constraint
// forces that they cause.
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

/// Over thirty members, because the steps of one algorithm share scratch memory.
class Untangler {
 public:
  explicit Untangler(const PairModel& model);

  /// Finds the vertices on a wrong side. `found` are all intersections at these positions.
  void begin_frame(const Record* positions, const std::vector<Intersection>& found);

  bool is_busy() const { return !pushes_.empty(); }
  /// True while untangling limits speeds: a cut-off part moves back, or a closed body still intersects a surface.
  bool limits_speeds() const { return !speeds_.empty(); }
  /// The number of vertices inside closed bodies.
  std::int64_t inside() const { return inside_; }
  /// True if a pair has no contact, because one of its primitives is on the wrong side of the other's part. Contact of
  /// a piece with itself stays.
  bool is_exempt(const PairStencil& pair) const;
  /// True if a part of this intersection is being moved.
  bool leads_apart(const Intersection& found) const;

  /// Moves vertices on a wrong side by at most `distance` [m] towards their target; the move replaces the prediction.
  /// It goes into the rounding residues, so it adds no velocity. Call it before anything else changes the prediction.
  void push(float distance, float h, Record* displacements, Record* remainders);

  /// Call it after a substep: limits the speed of vertices in moving parts to `limit` [m/s]; vertices on no wrong side
  /// may keep a higher predicted speed. `missing` is the gravity that a body's velocities do not include yet.
  void limit_speeds(float limit, Record* velocities, FunctionRef<Vec3f(int body)> missing) const;

 private:
  struct Push {
    int vertex;
    Vec3f direction;
    float remaining;  ///< distance that the vertex still has to move [m]
  };
  /// A vertex that moves back through a part, unless the trial shows that this creates more intersections.
  struct Candidate {
    Push push;
    int through, piece;
  };
  using PartPair = std::pair<int, int>;

  struct Closed {
    int body, part, first;  ///< indices of the closed body, of its part and of its first particle
    std::unique_ptr<MeshQuery> query;
  };

  void find_inside(const Record* positions);
  void lead_out(const std::vector<int>& patch, const Closed& closed, const Record* positions);
  int part_of(int vertex) const { return parts_.of[static_cast<std::size_t>(vertex)]; }
  int body_of(int vertex) const { return model_.shared->vertex_body[static_cast<std::size_t>(vertex)]; }
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
  std::vector<int> vertices_;  ///< all vertices with a cluster, ascending
  Parts parts_;
  std::vector<Closed> closed_;
  std::vector<int> wrong_side_of_;  ///< for each vertex, the part whose wrong side it is on, or -1; empty: no vertex is
  std::vector<int> piece_;          ///< index of the piece of each vertex on a wrong side
  std::vector<Push> pushes_;
  std::vector<char> led_;  ///< for each part, 1 if its speed is limited; empty: none is
  /// Vertices of parts with a speed limit, and their predicted speeds [m/s]
  std::vector<std::pair<int, float>> speeds_;
  std::int64_t inside_ = 0;
};

}  // namespace pliant
