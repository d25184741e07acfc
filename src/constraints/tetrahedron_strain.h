// What constraints on the shape of a tetrahedron have in common: D^-1 as rest data, and with it the deformation
// gradient F = [x1 - x0, x2 - x0, x3 - x0] D^-1, where the columns of D are the same three edges at rest.
#pragma once

#include <array>

#include "math/plastic_strain.h"
#include "pliant/formula.h"
#include "pliant/vec3.h"

namespace pliant {

/// A symmetric 3 x 3 matrix.
template <class R>
struct SymmetricTensor {
  R xx, yy, zz, xy, xz, yz;

  PLIANT_HD R trace() const { return xx + yy + zz; }
  /// The sum of the squares of its nine elements.
  PLIANT_HD R squares() const { return xx * xx + yy * yy + zz * zz + R(2) * (xy * xy + xz * xz + yz * yz); }
};

/// A 3 x 3 matrix by columns.
template <class R>
struct ByColumns {
  Vec3<R> x, y, z;

  PLIANT_HD R squares() const { return dot(x, x) + dot(y, y) + dot(z, z); }
  PLIANT_HD ByColumns operator*(const R& s) const { return {x * s, y * s, z * s}; }
  PLIANT_HD ByColumns operator+(const ByColumns& m) const { return {x + m.x, y + m.y, z + m.z}; }
  PLIANT_HD ByColumns times(const SymmetricTensor<R>& s) const {
    return {x * s.xx + y * s.xy + z * s.xz, x * s.xy + y * s.yy + z * s.yz, x * s.xz + y * s.yz + z * s.zz};
  }
};

/// A base of constraint types.
struct TetrahedronStrain {
  using slots = Points<4>;
  static constexpr int rows = 1;
  static constexpr bool is_length_of_strain = true;  ///< C is in proportion to |E|, whose direction it does not see

  template <class R>
  struct Params {
    R d00, d01, d02, d10, d11, d12, d20, d21, d22;  ///< D^-1 by rows [1/m]
  };
  static constexpr std::array<const char*, 9> fields{"d00", "d01", "d02", "d10", "d11", "d12", "d20", "d21", "d22"};

  /// The inverse of the rest edges; all zero, so that nothing moves, if their volume is below a millionth of their
  /// product.
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

  /// D^-1 becomes D^-1 U^-1, where U = exp(s e), of volume 1, is the part of the stretch that flows, and e the
  /// logarithmic strain at constant volume. `yield` and `most` are equivalent strains (von Mises) of it: log(l) for a
  /// bar l times as long.
  static bool flow(const SlotValues<slots, float>& at, Params<float>& p, const Params<float>& start,
                   const PlasticFlow& by) {
    const Matrix3d edges = columns(at.point[1] - at.point[0], at.point[2] - at.point[0], at.point[3] - at.point[0]);
    const Matrix3d f = product(edges, matrix(p));
    Matrix3d by_flow, by_limit;
    if (!flow_of(f, static_cast<double>(by.yield), -static_cast<double>(by.share), by_flow)) return false;
    Matrix3d to = product(matrix(p), by_flow);
    // The inverse of what is permanent, so of the same size.
    if (limit_of(product(inverse(matrix(start)), to), static_cast<double>(by.most), by_limit))
      to = product(to, by_limit);
    set(p, to);
    return true;
  }

  /// The deformation gradient F.
  template <class R>
  PLIANT_HD static ByColumns<R> deformation(const Vec3<R> (&x)[4], const Params<R>& p) {
    const Vec3<R> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    return {a * p.d00 + b * p.d10 + c * p.d20, a * p.d01 + b * p.d11 + c * p.d21, a * p.d02 + b * p.d12 + c * p.d22};
  }

  /// The gradients at the corners of what changes with F by `g`.
  template <class R>
  PLIANT_HD static void to_corners(const ByColumns<R>& g, const Params<R>& p, Vec3<R> (&gradient)[4]) {
    gradient[1] = g.x * p.d00 + g.y * p.d01 + g.z * p.d02;
    gradient[2] = g.x * p.d10 + g.y * p.d11 + g.z * p.d12;
    gradient[3] = g.x * p.d20 + g.y * p.d21 + g.z * p.d22;
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
  }

  /// Of the change E' = (F^T F' + F'^T F) / 2 of the strain with a change F' of F, what is across the strain E.
  template <class R>
  PLIANT_HD static SymmetricTensor<R> change_across(const ByColumns<R>& f, const ByColumns<R>& by) {
    const SymmetricTensor<R> e = green_strain(f);
    const R half(0.5f);
    const SymmetricTensor<R> all{dot(f.x, by.x),
                                 dot(f.y, by.y),
                                 dot(f.z, by.z),
                                 (dot(f.x, by.y) + dot(f.y, by.x)) * half,
                                 (dot(f.x, by.z) + dot(f.z, by.x)) * half,
                                 (dot(f.y, by.z) + dot(f.z, by.y)) * half};
    const R both =
        (e.xx * all.xx + e.yy * all.yy + e.zz * all.zz) + R(2) * (e.xy * all.xy + e.xz * all.xz + e.yz * all.yz);
    const R along = both / max(e.squares(), R(1e-14f));
    return {all.xx - e.xx * along, all.yy - e.yy * along, all.zz - e.zz * along,
            all.xy - e.xy * along, all.xz - e.xz * along, all.yz - e.yz * along};
  }

  /// Of the strain that a motion of the corners adds, what is across the present strain: sqrt(2) |E'|, with its
  /// gradients at the corners. The types of a solid measure |E| alone, so the damping of C would leave a strain that
  /// only changes its direction as it is.
  template <class R>
  PLIANT_HD static R strain_across(const Vec3<R> (&x)[4], const Vec3<R> (&motion)[4], const Params<R>& p,
                                   Vec3<R> (&gradient)[4]) {
    const ByColumns<R> f = deformation(x, p);
    const SymmetricTensor<R> across = change_across(f, deformation(motion, p));
    const R value = sqrt(R(2) * across.squares());
    const R scale = R(2) / max(value, R(1e-15f));
    const ByColumns<R> g = f.times(across);
    to_corners({g.x * scale, g.y * scale, g.z * scale}, p, gradient);
    return value;
  }

 private:
  static Matrix3d matrix(const Params<float>& p) {
    return {{p.d00, p.d01, p.d02, p.d10, p.d11, p.d12, p.d20, p.d21, p.d22}};
  }
  static void set(Params<float>& p, const Matrix3d& m) {
    const auto at = [&](int i) { return static_cast<float>(m[i]); };
    p = {at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8)};
  }

 protected:
  /// False where `measure` found no volume.
  template <class R>
  PLIANT_HD static auto is_solid(const Params<R>& p) {
    return p.d00 * p.d00 + p.d01 * p.d01 + p.d02 * p.d02 > R(0);
  }

  /// 1, or less where F is so large that squares of gradients in proportion to it would overflow: a factor of C and its
  /// gradients.
  template <class R>
  PLIANT_HD static R held(const ByColumns<R>& f) {
    constexpr float most_squared = 1e10f;
    return R(most_squared) / max(f.squares(), R(most_squared));
  }

  /// Green's strain E = (F^T F - 1) / 2.
  template <class R>
  PLIANT_HD static SymmetricTensor<R> green_strain(const ByColumns<R>& f) {
    const R one(1), half(0.5f);
    return {(dot(f.x, f.x) - one) * half, (dot(f.y, f.y) - one) * half, (dot(f.z, f.z) - one) * half,
            dot(f.x, f.y) * half,         dot(f.x, f.z) * half,         dot(f.y, f.z) * half};
  }
};

}  // namespace pliant
