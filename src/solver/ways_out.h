// The way out of a solid for points of an object that are deep inside of it, as where they start there.
//
// Contact moves each point to the side of the solid that is nearest to it. What begins deep inside of a solid would be
// torn to all sides, and what it stores in stretch would throw it out: a cloth of 10 cm in the middle of a box flew off
// with 455 m/s. So what is deep inside moves along one direction, at 1 m/s. All its points keep their distances, and
// contact takes back the speed along the normal. There is no friction.
#pragma once

#include <string>
#include <vector>

#include "collision/narrow/contact.h"
#include "geometry/convex_shape.h"

namespace pliant {

/// A solid that particles touch: of a body, or a collider.
struct TouchedSolid {
  const MovingCollider& moving;
  const ConvexShape* convex = nullptr;  ///< null: the shape or field of `moving`
  float margin = 0;                     ///< around a field, which belongs to the solid [m]
};

/// Where the points of an object leave a solid.
struct WayOut {
  int object = 0, solid = 0;
  Vec3f direction{};  ///< in the frame of the solid, of length 1
  float reach = 0;    ///< how far the solid reaches along it from the origin of its frame [m]
};

/// The distance of a place in a solid's frame from its surface, negative inside [m].
float distance_from(const TouchedSolid& solid, const Vec3f& place);

/// Finds the direction for points inside of a solid at `places` in its frame, which keep `thickness`. False where they
/// are not so deep that the nearest side of each would tear them. `down`: the direction of gravity in that frame.
/// `least_share`: what is not deeper than this share of half of the solid's thickness is not deep.
bool find_way_out(const TouchedSolid& solid, const std::vector<Vec3f>& places, float thickness, const Vec3f& down,
                  float least_share, WayOut& out);

/// The contact that moves a point along its way out in a substep of `h`. Its points and shares are left to the caller.
Contact contact_along(const TouchedSolid& solid, const WayOut& out, const Vec3f& position, float thickness, float h);

/// True if a contact of what is being led out holds it back or tears it: what is inside, or beside another side of the
/// solid. `place`: of the contact's points at the substep's start.
bool holds_back(const TouchedSolid& solid, const WayOut& out, const Contact& contact, const Vec3f& place);

/// True if an object has edges or triangles, so that what moves its points apart stores energy.
bool has_elements(const CompiledObject& object);

/// The warning for the points of an object that are inside of `what`, of which `first` is the first in the State.
std::string words_of_start(const Model& model, int object, int first, std::size_t points, const std::string& what);

/// An upper bound of the speed of a solid's surface in a substep of `h` [m/s].
float fastest_of(const MovingCollider& solid, float h);

}  // namespace pliant
