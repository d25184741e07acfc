// Contact: a particle stays on the outer side of a plane.
//
//         x            C(x) = n . x - offset >= 0
//     ----+----        n the surface's normal, offset = n . (point on the surface) + thickness
//
// Mueller et al. 2007, section 3.4. Both continuous contact (the plane where the path enters) and static contact (the
// plane at the closest surface point) use this constraint. It is projected only if C < 0.
#pragma once

#include <array>

#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct PlaneContact {
  static constexpr const char* name = "plane_contact";
  using slots = Points<1>;
  static constexpr int rows = 1;
  static constexpr bool unit_gradients = true;
  static constexpr bool unilateral = true;

  template <class R>
  struct Params {
    Vec3<R> normal;  ///< unit normal of the surface
    R offset;        ///< n . (point on the surface) + thickness [m]
  };

  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[1], const Params<R>& p, Vec3<R> (&gradient)[1]) {
    gradient[0] = p.normal;
    return dot(p.normal, x[0]) - p.offset;
  }
};

}  // namespace pliant
