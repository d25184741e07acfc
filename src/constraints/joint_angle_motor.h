// A motor or friction about a joint's x-axis: a torque up to `most` that imposes a speed. C is the twist (joint_rows.h).
//
//   speed = base speed + (target - twist) rate, the second term within +-most_speed
//
// Friction has rate and base speed zero. Compliance in rad/(s N m): the inverse rate of a viscous damper.
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct JointAngleMotor {
  static constexpr const char* name = "joint_angle_motor";
  using slots = joint::Bodies;
  static constexpr int rows = 1;
  static constexpr bool is_bounded = true, acts_on_motion = true;

  template <class R>
  struct Params {
    joint::Places<R> places;
    R target;      ///< angle, -pi..pi [rad]
    R rate;        ///< [1/s]
    R most_speed;  ///< towards the target [rad/s]
    R speed;       ///< base speed [rad/s]
    R most;        ///< greatest torque [N m]
  };
  static constexpr auto fields = joint::place_fields_and(
      std::array<const char*, 5>{"target", "rate", "greatest_speed", "base_speed", "greatest_torque"});

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    joint::twist(joint::pose(at, p.places), 0, out);
    const R wanted = joint::wrap(p.target - out.c[0]) * p.rate;
    out.speed[0] = p.speed + clamp(wanted, -p.most_speed, p.most_speed);
    out.low[0] = -p.most;
    out.high[0] = p.most;
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return {joint::measure_places(at), R(0), R(0), R(0), R(0), R(1)};
  }
};

}  // namespace pliant
