// How far a tetrahedron is from its rest shape, turned in whatever way: with TetrahedronVolume, a neo-Hookean solid.
//
//          3
//         /|\          C(x) = sqrt(|F|^2 + J^2 - 4 J),   F = [x1 - x0, x2 - x0, x3 - x0] D^-1,   J = det F
//        0-+-2
//         \|/          D: the same three edges at rest
//          1
//
// With alpha = 1 / (mu V0), C^2 / (2 alpha) is the stable neo-Hookean energy mu V0 / 2 (|F|^2 - 3 - 2 (J - 1)) (Smith, de Goes and
// Kim 2018, eq. 13, with the rest stability term moved here) plus mu V0 (J - 1)^2 / 2. So mu and lambda are the Lame
// coefficients, and each constraint vanishes at rest; the pair of Macklin and Mueller 2021 has two forces there that cancel, which
// a sweep that is not converged does not see. C also vanishes where F = 0, a point, which TetrahedronVolume opposes. Compliance in 1/J.
#pragma once

#include <array>

#include "math/plastic_strain.h"
#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

struct TetrahedronShear {
  static constexpr const char* name = "tetrahedron_shear";
  using slots = Points<4>;
  static constexpr int rows = 1;

  template <class R>
  struct Params {
    R d00, d01, d02, d10, d11, d12, d20, d21, d22;  ///< D^-1 by rows [1/m]
  };
  static constexpr std::array<const char*, 9> fields{"d00", "d01", "d02", "d10", "d11", "d12", "d20", "d21", "d22"};

  /// C is zero without a direction at rest, and where all corners are in one place; the gradients are then zero.
  template <class R>
  PLIANT_HD static R evaluate(const Vec3<R> (&x)[4], const Params<R>& p, Vec3<R> (&gradient)[4]) {
    const Vec3<R> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const Vec3<R> f0 = a * p.d00 + b * p.d10 + c * p.d20;  // the columns of F
    const Vec3<R> f1 = a * p.d01 + b * p.d11 + c * p.d21;
    const Vec3<R> f2 = a * p.d02 + b * p.d12 + c * p.d22;
    const Vec3<R> k0 = cross(f1, f2), k1 = cross(f2, f0), k2 = cross(f0, f1);  // dJ/dF
    const R value = sqrt(max(squared(f0, f1, f2, dot(f0, k0)), R(0)));
    const R per_c = R(1) / max(value, R(1e-7f));
    const R of_k = dot(f0, k0) - R(2);
    const Vec3<R> g0 = (f0 + k0 * of_k) * per_c;  // dC/dF
    const Vec3<R> g1 = (f1 + k1 * of_k) * per_c;
    const Vec3<R> g2 = (f2 + k2 * of_k) * per_c;
    gradient[1] = g0 * p.d00 + g1 * p.d01 + g2 * p.d02;
    gradient[2] = g0 * p.d10 + g1 * p.d11 + g2 * p.d12;
    gradient[3] = g0 * p.d20 + g1 * p.d21 + g2 * p.d22;
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
    return value;
  }

  /// The inverse of the rest edges; all zero, so that nothing moves, if their volume is below a millionth of their product.
  template <class R>
  PLIANT_HD static Params<R> measure(const Vec3<R> (&x)[4]) {
    const Vec3<R> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const R six = dot(cross(a, b), c);
    const R edges = sqrt(dot(a, a)) * sqrt(dot(b, b)) * sqrt(dot(c, c));
    const auto is_solid = abs(six) > edges * R(1e-6f);
    const R scale = select(is_solid, R(1) / select(is_solid, six, R(1)), R(0));
    const Vec3<R> r0 = cross(b, c) * scale, r1 = cross(c, a) * scale, r2 = cross(a, b) * scale;
    return {r0.x, r0.y, r0.z, r1.x, r1.y, r1.z, r2.x, r2.y, r2.z};
  }

  /// D^-1 becomes D^-1 U^-1, where U = exp(s e), of volume 1, is the part of the stretch that flows, and e the logarithmic strain at
  /// constant volume. `yield` and `most` are equivalent strains (von Mises) of it: log(l) for a bar l times as long.
  static bool flow(const SlotValues<slots, float>& at, Params<float>& p, const Params<float>& start,
                   const PlasticFlow& by) {
    const Matrix3d edges = columns(at.point[1] - at.point[0], at.point[2] - at.point[0], at.point[3] - at.point[0]);
    const Matrix3d f = product(edges, matrix(p));
    Matrix3d by_flow, by_limit;
    if (!flow_of(f, static_cast<double>(by.yield), -static_cast<double>(by.share), by_flow)) return false;
    Matrix3d to = product(matrix(p), by_flow);
    // The inverse of what is permanent, so of the same size.
    if (limit_of(product(inverse(matrix(start)), to), static_cast<double>(by.most), by_limit)) to = product(to, by_limit);
    set(p, to);
    return true;
  }

 private:
  static Matrix3d matrix(const Params<float>& p) {
    return {{p.d00, p.d01, p.d02, p.d10, p.d11, p.d12, p.d20, p.d21, p.d22}};
  }
  static void set(Params<float>& p, const Matrix3d& m) {
    const auto at = [&](int i) { return static_cast<float>(m[i]); };
    p = {at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8)};
  }

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
