// A motor or friction along a joint's x-axis: a force up to `most` that imposes a speed. C is u_x . d (joint_rows.h).
//
//   speed = base speed + (target - C) rate, the second term within +-most_speed
//
// Friction has rate and base speed zero. Compliance in m/(s N): the inverse rate of a viscous damper.
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct JointOffsetMotor {
  static constexpr const char* name = "joint_offset_motor";
  using slots = joint::Bodies;
  static constexpr int rows = 1;
  static constexpr bool is_bounded = true, acts_on_motion = true;

  template <class R>
  struct Params {
    joint::Places<R> places;
    R target;      ///< displacement [m]
    R rate;        ///< [1/s]
    R most_speed;  ///< towards the target [m/s]
    R speed;       ///< base speed [m/s]
    R most;        ///< greatest force [N]
  };
  static constexpr auto fields = joint::place_fields_and(
      std::array<const char*, 5>{"target", "rate", "greatest_speed", "base_speed", "greatest_force"});

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    joint::displacement(joint::pose(at, p.places), 0, 0, out);
    out.speed[0] = p.speed + clamp((p.target - out.c[0]) * p.rate, -p.most_speed, p.most_speed);
    out.low[0] = -p.most;
    out.high[0] = p.most;
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return {joint::measure_places(at), R(0), R(0), R(0), R(0), R(1)};
  }
};

}  // namespace pliant
