// A particle stays at a place of a rigid body, as a rope's end does that is tied to it.
//   C_k = e_k . (x_particle - x_body - R a), e_k the world's axes, a the place in the body's frame.   Compliance in m/N.
#pragma once

#include <array>

#include "pliant/formula.h"

namespace pliant {

struct BodyAnchor {
  static constexpr const char* name = "body_anchor";
  using slots = Slots<Point, Frame, Point>;  // body, its orientation, particle
  static constexpr int rows = 3;
  static constexpr bool is_tie = true;

  template <class R>
  struct Params {
    R x, y, z;  // a [m]
  };
  static constexpr std::array<const char*, 3> fields{"anchor_x", "anchor_y", "anchor_z"};

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const Vec3<R> arm = rotate(at.frame[1], Vec3<R>{p.x, p.y, p.z}), away = (at.point[2] - at.point[0]) - arm;
    const Vec3<R> axes[3] = {{R(1), R(0), R(0)}, {R(0), R(1), R(0)}, {R(0), R(0), R(1)}};
    for (int row = 0; row < rows; ++row) {
      out.c[row] = dot(axes[row], away);
      out.gradient[row][0] = -axes[row];
      out.gradient[row][1] = -cross(arm, axes[row]);  // a small rotation theta moves the place by theta x arm
      out.gradient[row][2] = axes[row];
    }
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    const Vec3<R> a = rotate(conjugate(at.frame[1]), at.point[2] - at.point[0]);
    return {a.x, a.y, a.z};
  }
};

}  // namespace pliant
