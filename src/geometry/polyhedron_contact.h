// Where two convex polyhedra touch: an axis that separates them best, and up to four points.
//
// Separating axes with the Gauss map to leave out edges that build no face of the Minkowski difference (Gregorius, "The
// separating axis test", GDC 2013), then one face clipped by the sides of the other (Sutherland and Hodgman 1974).
#pragma once

#include "geometry/polyhedron.h"
#include "geometry/touch.h"

namespace pliant {

/// The axis along which two polyhedra are farthest apart, or overlap least.
struct SeparatingAxis {
  enum class Kind { face_of_a, face_of_b, edges };
  Kind kind = Kind::face_of_a;
  int a = -1, b = -1;    ///< the face of one, or the edges of both
  float separation = 0;  ///< distance along the normal, negative if they overlap [m]
  Vec3f normal{};        ///< unit vector from a to b
};

/// The best axis of polyhedra in one frame. An axis of faces is preferred to one of edges that is hardly better, and
/// the face of a to that of b, so that resting contact does not change its kind by rounding. Any axis that separates
/// them by more than `reach` [m] will do.
SeparatingAxis separating_axis(const Polyhedron& a, const Polyhedron& b, float reach = 3e38f);

/// The points at which polyhedra in one frame touch, or might within `margin` [m]; none if they are farther apart.
Touch touch(const Polyhedron& a, const Polyhedron& b, float margin);

}  // namespace pliant
