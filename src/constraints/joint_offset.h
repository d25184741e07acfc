// The displacement of a joint along its x-axis stays between two bounds, or is driven to a value by a limited force.
//
//   C = u_x . d - nearer bound (joint_rows.h), one-sided; both bounds equal: C = u_x . d - bound.   Compliance in m/N.
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct JointOffset {
  static constexpr const char* name = "joint_offset";
  using slots = joint::Bodies;
  static constexpr int rows = 1;
  static constexpr bool is_bounded = true;

  template <class R>
  struct Params {
    joint::Places<R> places;
    R low, high;  ///< bounds [m]
    R most;       ///< greatest force [N]
  };
  static constexpr auto fields = joint::place_fields_and(std::array<const char*, 3>{"low", "high", "greatest_force"});

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    joint::displacement(joint::pose(at, p.places), 0, 0, out);
    joint::bound(out.c[0] - p.low, p.high - out.c[0], p.most, 0, out);
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return {joint::measure_places(at), R(0), R(0), R(joint::no_limit)};
  }
};

}  // namespace pliant
