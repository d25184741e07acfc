// A fixed joint: two bodies move as one. Three displacements, three rotations (joint_rows.h). Compliance in m/N and
// rad/(N m).
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct FixedJointRows {
  static constexpr const char* name = "fixed_joint";
  using slots = joint::Bodies;
  static constexpr int rows = 6;
  static constexpr bool is_joint = true;

  template <class R>
  using Params = joint::Places<R>;
  static constexpr auto fields = joint::place_fields;

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const joint::Posed<R> posed = joint::pose(at, p);
    const Quat<R> turned = joint::relative(posed.frame_a, posed.frame_b);
    joint::coincidence(posed, out);
    for (int axis = 0; axis < 3; ++axis) joint::rotation(posed, turned, axis, 3 + axis, out);
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return joint::measure_places(at);
  }
};

}  // namespace pliant
