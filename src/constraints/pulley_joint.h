// A rope from body a over two pulleys of a third body to body b.
//
//   C = |anchor_a - pulley_a| + ratio |anchor_b - pulley_b| - length <= 0      the rope only pulls      Compliance in m/N.
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct PulleyJointRows {
  static constexpr const char* name = "pulley_joint";
  using slots = Slots<Point, Frame, Point, Frame, Point, Frame>;  // a, b, the body with the pulleys
  static constexpr int rows = 1;
  static constexpr bool is_bounded = true;

  template <class R>
  struct Params {
    Vec3<R> anchor_a, anchor_b;  ///< relative to each body's centre, in its principal axes [m]
    Vec3<R> pulley_a, pulley_b;  ///< likewise, in the third body [m]
    R ratio;                     ///< of a tackle on the side of b [-]
    R length;                    ///< [m]
  };
  static constexpr std::array<const char*, 14> fields{
      "anchor_a_x", "anchor_a_y", "anchor_a_z", "anchor_b_x", "anchor_b_y", "anchor_b_z", "pulley_a_x",
      "pulley_a_y", "pulley_a_z", "pulley_b_x", "pulley_b_y", "pulley_b_z", "ratio",      "rope_length"};

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const Vec3<R> anchors[2] = {p.anchor_a, p.anchor_b}, pulleys[2] = {p.pulley_a, p.pulley_b};
    const R shares[2] = {R(1), p.ratio};
    out.c[0] = -p.length;
    out.gradient[0][4] = out.gradient[0][5] = {R(0), R(0), R(0)};
    for (int side = 0; side < 2; ++side) {
      const Vec3<R> arm = rotate(at.frame[2 * side + 1], anchors[side]), pulley = rotate(at.frame[5], pulleys[side]);
      const Vec3<R> d = (at.point[2 * side] + arm) - (at.point[4] + pulley);
      const R length = sqrt(dot(d, d));
      const Vec3<R> pull = d * (shares[side] / max(length, R(1e-20f)));
      out.c[0] = out.c[0] + shares[side] * length;
      out.gradient[0][2 * side] = pull;
      out.gradient[0][2 * side + 1] = cross(arm, pull);
      out.gradient[0][4] = out.gradient[0][4] - pull;
      out.gradient[0][5] = out.gradient[0][5] - cross(pulley, pull);
    }
    out.low[0] = -R(joint::no_limit);
    out.high[0] = R(0);
  }

  /// A rope from centre to centre over one pulley at the third body's centre.
  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    const Vec3<R> none{R(0), R(0), R(0)};
    Params<R> p{none, none, none, none, R(1), R(0)};
    for (int side = 0; side < 2; ++side) {
      const Vec3<R> d = at.point[2 * side] - at.point[4];
      p.length = p.length + sqrt(dot(d, d));
    }
    return p;
  }
};

}  // namespace pliant
