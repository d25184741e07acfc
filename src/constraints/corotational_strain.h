// How far a tetrahedron is from its rest shape in the rotation that is nearest: with TetrahedronVolume, a co-rotational
// solid.
//
//          3
//         /|\          C(x) = sqrt(2) |F - R|,   R: the rotation nearest to F
//        0-+-2
//         \|/          F as in tetrahedron_strain.h
//          1
//
// With alpha = 1 / (mu V0), C^2 / (2 alpha) is the energy mu V0 |F - R|^2, and with lambda V0 / 2 (J - 1)^2 of
// TetrahedronVolume that of the fixed co-rotational solid (Stomakhin, Howes, Schroeder and Teran 2012). As R is
// nearest, dC/dF = sqrt(2) (F - R) / |F - R|. Compliance in 1/J.
#pragma once

#include <type_traits>

#include "constraints/tetrahedron_strain.h"

namespace pliant {

struct CorotationalStrain : TetrahedronStrain {
  static constexpr const char* name = "corotational_strain";
  static constexpr bool is_of_solid = true;
  static constexpr bool is_arithmetic = true;

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
    const SymmetricTensor<R> e = green_strain(f);
    const ByColumns<R> far = less_rotation(f), near = f.times(less_inverse_stretch(e));
    const R volume = dot(f.x, cross(f.y, f.z));  // a mirrored one has the same E
    const auto is_near = e.squares() < select(volume > R(0), near_rest<R>(), R(-1));
    const ByColumns<R> g{select(is_near, near.x, far.x), select(is_near, near.y, far.y),
                         select(is_near, near.z, far.z)};
    const R value = sqrt(R(2) * g.squares());
    const R scale = R(2) / max(value, R(1e-7f));
    gradient = g * scale;
    return value;
  }

 private:
  /// Up to which square of the strain the series of `less_inverse_stretch` is more exact than the difference F - R.
  template <class R>
  PLIANT_HD static R near_rest() {
    if constexpr (std::is_same_v<R, double>)
      return 1e-9;
    else
      return R(4e-4f);
  }
  /// Of Newton. Where two singular values nearly cancel, as in a mirrored tetrahedron, many are needed and R hardly has
  /// a meaning.
  template <class R>
  static constexpr int iterations = std::is_same_v<R, double> ? 60 : 12;

  /// 1 - U^-1, where F = R U, so that F - R = F (1 - U^-1), from U^2 = 1 + 2 E: E - 3/2 E^2 + 5/2 E^3 - 35/8 E^4. F and
  /// R nearly cancel where the strain is small.
  template <class R>
  PLIANT_HD static SymmetricTensor<R> less_inverse_stretch(const SymmetricTensor<R>& e) {
    return times(e, times(e, times(e, scaled(e, R(-35 / 8.f)), R(2.5f)), R(-1.5f)), R(1));
  }

  template <class R>
  PLIANT_HD static SymmetricTensor<R> scaled(const SymmetricTensor<R>& a, const R& by) {
    return {a.xx * by, a.yy * by, a.zz * by, a.xy * by, a.xz * by, a.yz * by};
  }

  /// a (b + c), for matrices that commute.
  template <class R>
  PLIANT_HD static SymmetricTensor<R> times(const SymmetricTensor<R>& a, const SymmetricTensor<R>& b, const R& c) {
    const R xx = b.xx + c, yy = b.yy + c, zz = b.zz + c;
    return {a.xx * xx + a.xy * b.xy + a.xz * b.xz, a.xy * b.xy + a.yy * yy + a.yz * b.yz,
            a.xz * b.xz + a.yz * b.yz + a.zz * zz, a.xx * b.xy + a.xy * yy + a.xz * b.yz,
            a.xx * b.xz + a.xy * b.yz + a.xz * zz, a.xy * b.xz + a.yy * b.yz + a.yz * zz};
  }

  /// F - R. The sum s of the singular values of F, the least negative if F is inverted, is the largest root of
  /// s^4 - 2 |F|^2 s^2 - 8 J s + |F|^4 - 4 |K|^2, where K is the matrix of cofactors, and R its gradient ds/dF (Lin,
  /// Chitalu and Komura 2022). Newton's iteration comes down to it from sqrt(3) |F|. F of one direction alone has no R:
  /// the quotient is then held.
  template <class R>
  PLIANT_HD static ByColumns<R> less_rotation(const ByColumns<R>& given) {
    const R unit = R(1) / sqrt(max(given.squares(), R(1e-30f)));
    const ByColumns<R> f{given.x * unit, given.y * unit, given.z * unit};  // |F| = 1
    const ByColumns<R> k{cross(f.y, f.z), cross(f.z, f.x), cross(f.x, f.y)};
    const R j = R(8) * dot(f.x, k.x), rest = R(1) - R(4) * k.squares();
    R s(1.7320508f);
    for (int i = 0; i < iterations<R>; ++i) {
      const R square = s * s;
      const R slope = max(R(4) * s * (square - R(1)) - j, R(1e-4f));
      s = s - max((square - R(2)) * square - j * s + rest, R(0)) / slope;
    }
    const R four_square = R(4) * s * s, per_slope = R(1) / max(s * (four_square - R(4)) - j, R(1e-4f));
    const SymmetricTensor<R> c{dot(f.x, f.x), dot(f.y, f.y), dot(f.z, f.z),
                               dot(f.x, f.y), dot(f.x, f.z), dot(f.y, f.z)};
    const ByColumns<R> fc = f.times(c);
    const R of_f = (four_square + R(4)) * per_slope, of_k = R(8) * s * per_slope, of_fc = R(8) * per_slope;
    return {given.x - (f.x * of_f + k.x * of_k - fc.x * of_fc), given.y - (f.y * of_f + k.y * of_k - fc.y * of_fc),
            given.z - (f.z * of_f + k.z * of_k - fc.z * of_fc)};
  }
};

}  // namespace pliant
