// Two gears that rotate about axes fixed in a third body.
//
//   C = wrap(teeth_a angle_a + teeth_b angle_b) / teeth_a      angles: twists against the third body (joint_rows.h)
//
// With whole numbers of teeth, angles that grow by full turns change C by full turns, so C needs no memory. A gear that
// is forced by more than half a tooth slips to the next. Compliance in rad/(N m), of gear a.
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct GearJointRows {
  static constexpr const char* name = "gear_joint";
  using slots = Slots<Frame, Frame, Frame>;  // a, b, the body in which the axes are fixed
  static constexpr int rows = 1;

  template <class R>
  struct Params {
    Quat<R> axes_a, axes_b;  ///< from the gear's frame, which rotates about its x-axis, to the principal axes
    Quat<R> carrier_of_a, carrier_of_b;  ///< the same in the third body
    R teeth_a, teeth_b;                  ///< whole numbers, not 0 [-]
  };
  static constexpr std::array<const char*, 18> fields{
      "axes_a_x",       "axes_a_y",       "axes_a_z",       "axes_a_w",       "axes_b_x",       "axes_b_y",
      "axes_b_z",       "axes_b_w",       "carrier_of_a_x", "carrier_of_a_y", "carrier_of_a_z", "carrier_of_a_w",
      "carrier_of_b_x", "carrier_of_b_y", "carrier_of_b_z", "carrier_of_b_w", "teeth_a",        "teeth_b"};

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const auto a = joint::twist_of(multiply(at.frame[2], p.carrier_of_a), multiply(at.frame[0], p.axes_a));
    const auto b = joint::twist_of(multiply(at.frame[2], p.carrier_of_b), multiply(at.frame[1], p.axes_b));
    out.c[0] = joint::wrap_turns(p.teeth_a * a.angle + p.teeth_b * b.angle) / p.teeth_a;
    out.gradient[0][0] = a.gradient;
    out.gradient[0][1] = b.gradient * (p.teeth_b / p.teeth_a);
    out.gradient[0][2] = -(out.gradient[0][0] + out.gradient[0][1]);
  }

  /// Equal gears about the world's x-axis.
  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    const Quat<R> carrier = conjugate(at.frame[2]);
    return {conjugate(at.frame[0]), conjugate(at.frame[1]), carrier, carrier, R(1), R(1)};
  }
};

}  // namespace pliant
