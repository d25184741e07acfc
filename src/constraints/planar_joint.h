// A planar joint: body b slides in the plane perpendicular to the joint's x-axis and rotates about that axis
// (joint_rows.h). Compliance in m/N and rad/(N m).
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct PlanarJointRows {
  static constexpr const char* name = "planar_joint";
  using slots = joint::Bodies;
  static constexpr int rows = 3;
  static constexpr bool is_joint = true;

  template <class R>
  using Params = joint::Places<R>;
  static constexpr auto fields = joint::place_fields;

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const joint::Posed<R> posed = joint::pose(at, p);
    joint::displacement(posed, 0, 0, out);
    joint::alignment(posed, 1, 0, 1, out);
    joint::alignment(posed, 2, 0, 2, out);
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return joint::measure_places(at);
  }
};

}  // namespace pliant
