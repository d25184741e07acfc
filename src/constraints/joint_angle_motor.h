// A motor or friction about a joint's x-axis: a torque up to `most` that imposes a speed. C is the twist
// (joint_rows.h).
//
//   speed = base speed + (target - twist) rate, the second term within +-most_speed
//
// It turns to its target the shorter way, but where the joint has a range it does not turn through the range's stops.
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
    R middle;      ///< of the joint's range [rad]; no_limit: it has none
  };
  static constexpr auto fields = joint::place_fields_and(
      std::array<const char*, 6>{"target", "rate", "greatest_speed", "base_speed", "greatest_torque", "range_middle"});

  /// The turn from an angle to the target [rad]: the shorter one, or within the range. Both differ by a full turn, or
  /// by rounding.
  template <class R>
  PLIANT_HD static R way(const R& angle, const Params<R>& p) {
    const R shorter = joint::wrap(p.target - angle);
    const R within = joint::wrap(p.target - p.middle) - joint::wrap(angle - p.middle);
    const R apart = within - shorter;
    const R inside = select(apart > R(3), within, select(apart < R(-3), within, shorter));
    return select(p.middle < R(joint::no_limit), inside, shorter);
  }

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    joint::twist(joint::pose(at, p.places), 0, out);
    const R wanted = way(out.c[0], p) * p.rate;
    out.speed[0] = p.speed + clamp(wanted, -p.most_speed, p.most_speed);
    out.low[0] = -p.most;
    out.high[0] = p.most;
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return {joint::measure_places(at), R(0), R(0), R(0), R(0), R(1), R(joint::no_limit)};
  }
};

}  // namespace pliant
