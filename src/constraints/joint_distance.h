// The distance of two anchors stays between two bounds, or is kept if both are equal: a rod, a rope, a spring.
//
//   C = |d| - nearer bound (joint_rows.h)   Compliance in m/N.
#pragma once

#include <array>

#include "constraints/joint_rows.h"

namespace pliant {

struct JointDistance {
  static constexpr const char* name = "joint_distance";
  using slots = joint::Bodies;
  static constexpr int rows = 1;
  static constexpr bool is_bounded = true;

  template <class R>
  struct Params {
    Vec3<R> anchor_a, anchor_b;  ///< relative to each body's centre, in its principal axes [m]
    R least, most;               ///< distances [m]
  };
  static constexpr std::array<const char*, 8> fields{"anchor_a_x", "anchor_a_y", "anchor_a_z",     "anchor_b_x",
                                                     "anchor_b_y", "anchor_b_z", "least_distance", "greatest_distance"};

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const Vec3<R> a = rotate(at.frame[1], p.anchor_a), b = rotate(at.frame[3], p.anchor_b);
    const Vec3<R> d = (at.point[2] + b) - (at.point[0] + a);
    const R length = sqrt(dot(d, d));
    const Vec3<R> n = d * (R(1) / max(length, R(1e-20f)));
    joint::bound(length - p.least, p.most - length, R(joint::no_limit), 0, out);
    out.gradient[0][0] = -n;
    out.gradient[0][1] = -cross(a, n);
    out.gradient[0][2] = n;
    out.gradient[0][3] = cross(b, n);
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    const Vec3<R> d = at.point[2] - at.point[0], none{R(0), R(0), R(0)};
    const R length = sqrt(dot(d, d));
    return {none, none, length, length};
  }
};

}  // namespace pliant
