// Vertices that two bodies, or a body and a collider, press on from opposite sides.
//
// A light vertex passes little of what one side does on to the other in a pass: a crate of 8 500 of its masses would
// have to be projected a thousand times until its weight and its friction reach the table beneath the cloth. So both
// sides get one impulse in addition, as if the vertex joined them: along the normal as much as keeps the room between
// them from shrinking, and across it what keeps them from sliding on one another, within the cones of both contacts.
// Nothing is left for the vertex, so momentum is kept. Where cloth is pulled along between both, as a rug beneath a load,
// they do not hold one another: each has friction with the cloth alone.
#pragma once

#include <cstddef>
#include <vector>

#include "collision/narrow/contact.h"
#include "solver/bodies/body_solids.h"
#include "solver/bodies/manifold_passes.h"

namespace pliant {

struct Substep;

/// How a body has moved since contacts were found, and in this pass.
struct BodyProgress {
  Vec3f displacement{}, rotation{};       ///< at the prediction [m], [rad]
  Vec3f moved{}, turned{};                ///< since then
  Vec3f moved_before{}, turned_before{};  ///< those when the pass began
};

class PinchedPoints {
 public:
  /// What PointImpulses has for it.
  struct Parts {
    const BodySolids& solids;
    const std::vector<BodyMotion>& motions;
    std::vector<Contact>& contacts;
    std::vector<float>& impulses;  ///< of contacts along their normals [N s]
    std::vector<BodyProgress>& progress;
  };

  /// Finds them among the contacts of a substep, with bodies and with colliders.
  void find(const Substep& s, const BodySolids& solids, const std::vector<Contact>& contacts);
  /// Projects each, in the order of vertices. Contacts have been projected, and are those for which pinched vertices
  /// were found. Unless `of` is null only vertices of the objects for which it is not zero.
  void project(Substep& s, const Parts& parts, const std::vector<char>* of) const;

 private:
  /// What presses from the other side.
  enum class Other { body, mesh, collider };
  struct Pinch {
    int contact = 0;  ///< with the body
    int other = 0;    ///< contact with the other body, of SurfaceContact with a mesh collider, or the other collider
    Other kind = Other::body;
    float side = 1;  ///< -1: the vertex is on the second side of that one
    int task = 0;    ///< tile of a contact with another collider
  };
  /// A contact of a vertex by its index.
  struct Touch {
    int vertex = 0, contact = 0;
  };

  std::vector<Touch>::const_iterator first_touch_from(int vertex) const;
  void find_between_bodies(const BodySolids& solids, const std::vector<Contact>& contacts);
  void find_at_meshes(const Substep& s, const std::vector<Contact>& contacts);
  void find_at_colliders(const Substep& s, const std::vector<Contact>& contacts);
  void find_held(const Substep& s);
  void project(Substep& s, const Parts& parts, const Pinch& pinch) const;

  std::vector<Pinch> pinches_;
  std::vector<Touch> touches_;  ///< of single vertices and bodies, by vertex
  std::vector<char> is_held_;   ///< [object] nonzero: it has pinched vertices, and particles that are fixed
};

}  // namespace pliant
