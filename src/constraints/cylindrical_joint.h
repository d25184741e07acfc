// A cylindrical joint: body b slides along the joint's x-axis and rotates about it. Displacements along y and z, and x
// of b perpendicular to y and z of a (joint_rows.h). Compliance in m/N and rad/(N m).
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct CylindricalJointRows {
  static constexpr const char* name = "cylindrical_joint";
  using slots = joint::Bodies;
  static constexpr int rows = 4;
  static constexpr bool is_joint = true;

  template <class R>
  using Params = joint::Places<R>;
  static constexpr auto fields = joint::place_fields;

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const joint::Posed<R> posed = joint::pose(at, p);
    for (int axis = 1; axis < 3; ++axis) {
      joint::displacement(posed, axis, axis - 1, out);
      joint::alignment(posed, axis, 0, axis + 1, out);
    }
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return joint::measure_places(at);
  }
};

}  // namespace pliant
