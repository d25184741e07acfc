// A pinion that moves a rack. The pinion's axis and the rack's direction are fixed in a third body.
//
//   C = r wrap((u . (x_rack - x_third) - start) / r - angle)      angle: twist of the pinion (joint_rows.h)
//
// C is taken modulo a turn of the pinion, so it needs no memory. Compliance in m/N.
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct RackJointRows {
  static constexpr const char* name = "rack_joint";
  using slots = Slots<Frame, Point, Point, Frame>;  // pinion, rack, the third body's point and frame
  static constexpr int rows = 1;

  template <class R>
  struct Params {
    Quat<R> axes, carrier_axes;  ///< from the pinion's frame, which rotates about its x-axis, to both principal axes
    Vec3<R> direction;           ///< unit vector u in the third body's principal axes
    R start;                     ///< u . (x_rack - x_third) at angle 0 [m]
    R radius;                    ///< r [m]
  };
  static constexpr std::array<const char*, 13> fields{
      "axes_x",    "axes_y",      "axes_z",      "axes_w",      "carrier_x", "carrier_y", "carrier_z",
      "carrier_w", "direction_x", "direction_y", "direction_z", "start",     "radius"};

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const auto pinion = joint::twist_of(multiply(at.frame[3], p.carrier_axes), multiply(at.frame[0], p.axes));
    const Vec3<R> u = rotate(at.frame[3], p.direction), away = at.point[1] - at.point[2];
    out.c[0] = p.radius * joint::wrap_turns((dot(u, away) - p.start) / p.radius - pinion.angle);
    out.gradient[0][0] = pinion.gradient * -p.radius;
    out.gradient[0][1] = u;
    out.gradient[0][2] = -u;
    out.gradient[0][3] = pinion.gradient * p.radius + cross(u, away);
  }

  /// A pinion of radius 1 about the world's x-axis that moves the rack along y.
  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    const Quat<R> carrier = conjugate(at.frame[3]);
    return {conjugate(at.frame[0]), carrier, rotate(carrier, joint::unit<R>(1)), at.point[1].y - at.point[2].y, R(1)};
  }
};

}  // namespace pliant
