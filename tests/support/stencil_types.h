// Constraint types defined through pliant/constraint.h, as users define them: with frame slots, several rows or eight
// points. They include only public headers.
#pragma once

#include <array>

#include "pliant/constraint.h"

namespace pliant::testing_support {

/// Two bodies, a point and a frame each, share an anchor. C is the vector between their anchors in world axes [m].
struct TestJoint {
  static constexpr const char* name = "test_joint";
  using slots = Slots<Point, Frame, Point, Frame>;
  static constexpr int rows = 3;

  template <class R>
  struct Params {
    Vec3<R> anchor_a, anchor_b;  ///< position of the anchor relative to each body's centre, in the body's axes [m]
  };
  static constexpr std::array<const char*, 6> fields{"anchor_ax", "anchor_ay", "anchor_az",
                                                     "anchor_bx", "anchor_by", "anchor_bz"};

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const Vec3<R> a = rotate(at.frame[1], p.anchor_a), b = rotate(at.frame[3], p.anchor_b);
    const Vec3<R> gap = (at.point[2] + b) - (at.point[0] + a);
    const R c[3] = {gap.x, gap.y, gap.z};
    const Vec3<R> axis[3] = {{R(1), R(0), R(0)}, {R(0), R(1), R(0)}, {R(0), R(0), R(1)}};
    for (int row = 0; row < 3; ++row) {
      out.c[row] = c[row];
      out.gradient[row][0] = -axis[row];
      out.gradient[row][1] = -cross(a, axis[row]);
      out.gradient[row][2] = axis[row];
      out.gradient[row][3] = cross(b, axis[row]);
    }
  }
};

/// A point keeps its distances from two others: two rows, solved together. C in metres.
struct TwoBars {
  static constexpr const char* name = "two_bars";
  using slots = Points<3>;
  static constexpr int rows = 2;

  template <class R>
  struct Params {
    R first, second;
  };
  static constexpr std::array<const char*, 2> fields{"first_length", "second_length"};

  template <class R>
  PLIANT_HD static void evaluate(const SlotValues<slots, R>& at, const Params<R>& p, Rows<slots, rows, R>& out) {
    const R rest[2] = {p.first, p.second};
    for (int row = 0; row < 2; ++row) {
      const Vec3<R> d = at.point[2] - at.point[row];
      const R length = sqrt(dot(d, d));
      const Vec3<R> way = d * (R(1) / max(length, R(1e-20f)));
      out.c[row] = length - rest[row];
      out.gradient[row][row] = -way;
      out.gradient[row][1 - row] = {R(0), R(0), R(0)};
      out.gradient[row][2] = way;
    }
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const SlotValues<slots, R>& at) {
    const Vec3<R> a = at.point[2] - at.point[0], b = at.point[2] - at.point[1];
    return {sqrt(dot(a, a)), sqrt(dot(b, b))};
  }
};

/// Eight points keep their spread, the root mean square distance from their mean [m]. Uses the short form of evaluate.
struct Spread {
  static constexpr const char* name = "spread";
  using slots = Points<8>;
  static constexpr int rows = 1;

  template <class R>
  struct Params {
    R spread;
  };
  static constexpr std::array<const char*, 1> fields{"spread"};

  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[8], const Params<R>& p, Vec3<R> (&gradient)[8]) {
    Vec3<R> mean = x[0];
    for (int i = 1; i < 8; ++i) mean = mean + x[i];
    mean = mean * R(0.125f);
    R squares = R(0);
    for (int i = 0; i < 8; ++i) squares = squares + length_squared(x[i] - mean);
    const R spread = sqrt(squares * R(0.125f));
    const R scale = R(0.125f) / max(spread, R(1e-20f));
    for (int i = 0; i < 8; ++i) gradient[i] = (x[i] - mean) * scale;
    return spread - p.spread;
  }

  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[8]) {
    Vec3<R> gradient[8];
    return {evaluate(x, Params<R>{R(0)}, gradient)};
  }
};

inline void register_test_types() {
  register_constraint<TestJoint>();
  register_constraint<TwoBars>();
  register_constraint<Spread>();
}

}  // namespace pliant::testing_support
