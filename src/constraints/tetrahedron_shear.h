// How far a tetrahedron is from its rest shape, turned in whatever way: with TetrahedronVolume, a neo-Hookean solid.
//
//          3
//         /|\          C(x) = sqrt(|F|^2 + J^2 - 4 J),   F = [x1 - x0, x2 - x0, x3 - x0] D^-1,   J = det F
//        0-+-2
//         \|/          D: the same three edges at rest
//          1
//
// With alpha = 1 / (mu V0), C^2 / (2 alpha) is the stable neo-Hookean energy mu V0 / 2 (|F|^2 - 3 - 2 (J - 1)) (Smith,
// de Goes and Kim 2018, eq. 13, with the rest stability term moved here) plus mu V0 (J - 1)^2 / 2. So mu and lambda are
// the Lame coefficients, and each constraint vanishes at rest; the pair of Macklin and Mueller 2021 has two forces
// there that cancel, which a sweep that is not converged does not see. C also vanishes where F = 0, a point, which
// TetrahedronVolume opposes. Compliance in 1/J.
#pragma once

#include "constraints/tetrahedron_strain.h"

namespace pliant {

struct TetrahedronShear : TetrahedronStrain {
  static constexpr const char* name = "tetrahedron_shear";
  static constexpr bool is_of_solid = true;

  /// C is zero without a direction at rest, and where all corners are in one place; the gradients are then zero.
  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[4], const Params<R>& p, Vec3<R> (&gradient)[4]) {
    ByColumns<R> of_f;
    const R value = evaluate_at(deformation(x, p), p, of_f);
    to_corners(of_f, p, gradient);
    return value;
  }

  /// C and dC/dF of F.
  template <class R>
  PLIANT_HD static R evaluate_at(const ByColumns<R>& f, const Params<R>& /*p*/, ByColumns<R>& gradient) {
    const Vec3<R>&f0 = f.x, &f1 = f.y, &f2 = f.z;
    const Vec3<R> k0 = cross(f1, f2), k1 = cross(f2, f0), k2 = cross(f0, f1);  // dJ/dF
    const R value = sqrt(max(squared(f0, f1, f2, dot(f0, k0)), R(0)));
    const R per_c = R(1) / max(value, R(1e-7f));
    const R of_k = dot(f0, k0) - R(2);
    gradient = {(f0 + k0 * of_k) * per_c, (f1 + k1 * of_k) * per_c, (f2 + k2 * of_k) * per_c};
    return value;
  }

  /// The two parts |F| and J - 2 of C^2 = |F|^2 + (J - 2)^2 - 4, and their derivatives by F. Returns C.
  template <class R>
  PLIANT_HD static R split(const ByColumns<R>& f, R (&value)[2], ByColumns<R> (&gradient)[2]) {
    value[0] = sqrt(f.squares());
    gradient[0] = f * (R(1) / max(value[0], R(1e-7f)));
    gradient[1] = {cross(f.y, f.z), cross(f.z, f.x), cross(f.x, f.y)};
    value[1] = dot(f.x, gradient[1].x) - R(2);
    return sqrt(max(f.squares() + value[1] * value[1] - R(4), R(1e-14f)));
  }

  /// Where a step along dC/dF that takes C to be linear would go far beyond the least energy: with G = F + (J - 2)
  /// dJ/dF = C dC/dF, C^2 / 2 changes along G by |G|^2 at first, and that by about |G|^2 + (dJ/dF . G)^2, where a
  /// linear C has |G|^4 / C^2. In the dilation of a cube at rest (dJ/dF . G)^2 is twice that and without effect, hence
  /// 3. None where the strain is small.
  template <class R>
  PLIANT_HD static auto needs_split(const ByColumns<R>& f) {
    const Vec3<R> k0 = cross(f.y, f.z), k1 = cross(f.z, f.x), k2 = cross(f.x, f.y);
    const R j = dot(f.x, k0), of_k = j - R(2), lengths = f.squares(), areas = dot(k0, k0) + dot(k1, k1) + dot(k2, k2);
    const R force = min(lengths + R(6) * (j * of_k) + areas * (of_k * of_k), R(1e18f));
    const R along = min(abs(R(3) * j + areas * of_k), R(1e15f));
    const R linear = R(3) * force * (force / max(force + along * along, R(1e-30f)));
    const R squared = lengths + j * (j - R(4));
    const R most = select(lengths < R(4), select(j > R(0.5f), R(0), squared), select(lengths < R(1e8f), squared, R(0)));
    return linear < most;
  }

 private:
  /// |F|^2 + J^2 - 4 J. Near rest three large terms cancel there, so it is computed from Green's strain E = (F^T F - 1) / 2 with
  /// the invariants of E: 2 d^2 - 4 I2 - 8 I3, where d = J - 1 and J^2 - 1 = 2 I1 + 4 I2 + 8 I3.
  template <class R>
  PLIANT_HD static R squared(const Vec3<R>& f0, const Vec3<R>& f1, const Vec3<R>& f2, const R& j) {
    const R one(1), half(0.5f);
    const R m00 = dot(f0, f0), m11 = dot(f1, f1), m22 = dot(f2, f2);
    const R e00 = (m00 - one) * half, e11 = (m11 - one) * half, e22 = (m22 - one) * half;
    const R e01 = dot(f0, f1) * half, e02 = dot(f0, f2) * half, e12 = dot(f1, f2) * half;
    const R i1 = e00 + e11 + e22;
    const R minor = e11 * e22 - e12 * e12;
    const R i2 = minor + (e00 * e22 - e02 * e02) + (e00 * e11 - e01 * e01);
    const R i3 = e00 * minor - e01 * (e01 * e22 - e12 * e02) + e02 * (e01 * e12 - e11 * e02);
    const R d = (R(2) * i1 + R(4) * i2 + R(8) * i3) / (one + max(j, half));
    const R near = R(2) * (d * d) - R(4) * i2 - R(8) * i3;
    const R far = (m00 + m11 + m22) + j * (j - R(4));
    return select(j > half, select(i1 < half, near, far), far);
  }
};

}  // namespace pliant
