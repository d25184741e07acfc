// A ball joint: two bodies share a point.   C = d in world axes (joint_rows.h)   Compliance in m/N.
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct BallJointRows {
  static constexpr const char* name = "ball_joint";
  using slots = joint::Bodies;
  static constexpr int rows = 3;
  static constexpr bool is_joint = true;

  template <class R>
  using Params = joint::Places<R>;
  static constexpr auto fields = joint::place_fields;

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const joint::Posed<R> posed = joint::pose(at, p);
    joint::coincidence(posed, out);
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return joint::measure_places(at);
  }
};

}  // namespace pliant
