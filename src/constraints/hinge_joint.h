// A hinge: two bodies share a point and the joint's x-axis. Three displacements, and x of b perpendicular to y and z of
// a (joint_rows.h). Compliance in m/N and rad/(N m).
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct HingeJointRows {
  static constexpr const char* name = "hinge_joint";
  using slots = joint::Bodies;
  static constexpr int rows = 5;
  static constexpr bool is_joint = true;

  template <class R>
  using Params = joint::Places<R>;
  static constexpr auto fields = joint::place_fields;

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const joint::Posed<R> posed = joint::pose(at, p);
    joint::coincidence(posed, out);
    joint::alignment(posed, 1, 0, 3, out);
    joint::alignment(posed, 2, 0, 4, out);
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return joint::measure_places(at);
  }
};

}  // namespace pliant
