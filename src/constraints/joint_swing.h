// The x-axis of body b stays within a cone about the x-axis of body a.
//
//   C = atan2(|u_x x v_x|, u_x . v_x) - most <= 0 (joint_rows.h)   Compliance in rad/(N m).
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct JointSwing {
  static constexpr const char* name = "joint_swing";
  using slots = joint::Bodies;
  static constexpr int rows = 1;
  static constexpr bool is_bounded = true;

  template <class R>
  struct Params {
    joint::Places<R> places;
    R most;  ///< greatest angle, 0..pi [rad]
  };
  static constexpr auto fields = joint::place_fields_and(std::array<const char*, 1>{"greatest_angle"});

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const joint::Posed<R> posed = joint::pose(at, p.places);
    const Vec3<R> u = posed.axis_of_a(0), v = posed.axis_of_b(0), n = cross(u, v);
    const R sine = sqrt(dot(n, n));
    out.c[0] = atan2(sine, dot(u, v)) - p.most;
    joint::set_rotation(n * (R(1) / max(sine, R(1e-12f))), 0, out);
    out.low[0] = -R(joint::no_limit);
    out.high[0] = R(0);
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    return {joint::measure_places(at), R(0)};
  }
};

}  // namespace pliant
