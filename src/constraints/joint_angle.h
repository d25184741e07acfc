// The angle of a joint about its x-axis stays between two bounds, or is driven to a value by a limited torque.
//
//   C = twist - nearer bound (joint_rows.h), one-sided; both bounds equal: C = twist - bound.   Compliance in rad/(N m).
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct JointAngle {
  static constexpr const char* name = "joint_angle";
  using slots = joint::Bodies;
  static constexpr int rows = 1;
  static constexpr bool is_bounded = true;

  template <class R>
  struct Params {
    joint::Places<R> places;
    R middle;      ///< of the range, -pi..pi [rad]
    R half_width;  ///< of the range, 0..pi [rad]
    R most;        ///< greatest torque [N m]
  };
  static constexpr auto fields =
      joint::place_fields_and(std::array<const char*, 3>{"middle", "half_width", "greatest_torque"});

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    joint::twist(joint::pose(at, p.places), 0, out);
    const R from_middle = joint::wrap(out.c[0] - p.middle);
    joint::bound(from_middle + p.half_width, p.half_width - from_middle, p.most, 0, out);
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return {joint::measure_places(at), R(0), R(0), R(joint::no_limit)};
  }
};

}  // namespace pliant
