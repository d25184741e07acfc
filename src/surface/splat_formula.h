// A particle's kernel from the moments of its neighbours, for one particle (float) or sixteen (Wide).
//
// Yu and Turk (2013) take the ellipsoid from the covariance C of a particle's neighbours, by a decomposition whose
// eigenvalues they clamp. Here its squared radii are those of a C + b I, with constants a and b. So small radii are
// bounded below without a decomposition, a particle without neighbours (C = 0) has a ball, and nothing jumps when a
// neighbour comes or goes.
#pragma once

#include "math/scalar.h"

namespace pliant::surface {

inline constexpr float search_radius = 2;    ///< of neighbours, as a share of the spacing
inline constexpr float lone_squared = 1.1f;  ///< squared radius of the kernel of a particle alone, in spacings^2
inline constexpr float full_squared = 4;     ///< the same for one with neighbours on all sides
/// The variance along each axis of neighbours on all sides: their weights are 1 - r^2 / R^2, so it is R^2 / 7.
inline constexpr float full_variance = search_radius * search_radius / 7;
inline constexpr float stretch = (full_squared - lone_squared) / full_variance;
/// A particle alone weighs so much more that its ball has the volume spacing^3.
inline constexpr float lone_gain = 0.45f;
inline constexpr float most_variance = 4.2f * full_variance;  ///< bound of the sum along three axes; it is 3 at rest

/// A symmetric 3 x 3 matrix.
template <class R>
struct Symmetric {
  R xx, yy, zz, xy, xz, yz;
};

/// A kernel, as in Splat.
template <class R>
struct Kernel {
  Symmetric<R> a;
  R weight, widest;
  Vec3<R> reach;
};

template <class R>
PLIANT_HD R number(float value) {
  return R(value);
}

/// The covariance of neighbours about their mean, in spacings^2: from the sum of their weights, and the sums of their
/// weighted places and products of places relative to the particle [m, m^2].
template <class R>
PLIANT_HD Symmetric<R> covariance(const R& sum, const Vec3<R>& places, const Symmetric<R>& products, float spacing) {
  const R per_sum = number<R>(1) / sum, scale = number<R>(1 / (spacing * spacing));  // its own weight is 1, so sum >= 1
  const R x = places.x * per_sum, y = places.y * per_sum, z = places.z * per_sum;
  return {(products.xx * per_sum - x * x) * scale, (products.yy * per_sum - y * y) * scale,
          (products.zz * per_sum - z * z) * scale, (products.xy * per_sum - x * y) * scale,
          (products.xz * per_sum - x * z) * scale, (products.yz * per_sum - y * z) * scale};
}

template <class R>
PLIANT_HD R trace_of(const Symmetric<R>& c) {
  const R zero = number<R>(0);
  return max(c.xx, zero) + max(c.yy, zero) + max(c.zz, zero);
}

/// The kernel's weight: 1 with neighbours on all sides, 1.02 at a flat surface.
template <class R>
PLIANT_HD R gain_of(const R& trace) {
  const R missing = max(number<R>(0), number<R>(1) - trace * number<R>(1 / (3 * full_variance)));
  return number<R>(1) + number<R>(lone_gain) * (missing * missing);
}

/// The squared radii of the kernel as a matrix, in spacings^2.
template <class R>
PLIANT_HD Symmetric<R> squared_radii(const Symmetric<R>& c, const R& trace, bool anisotropic) {
  const R zero = number<R>(0), lone = number<R>(lone_squared);
  const R a = number<R>(stretch * most_variance) / max(trace, number<R>(most_variance));
  const R same = a * trace * number<R>(1.f / 3) + lone;
  if (!anisotropic) return {same, same, same, zero, zero, zero};
  return {
      a * max(c.xx, zero) + lone, a * max(c.yy, zero) + lone, a * max(c.zz, zero) + lone, a * c.xy, a * c.xz, a * c.yz};
}

/// The bound of an ellipsoid by one along the axes with the same reach: 1 + the largest sum of two correlations
/// (Gershgorin).
template <class R>
PLIANT_HD R widest_of(const Symmetric<R>& r, const Vec3<R>& per_root) {
  const R xy = abs(r.xy) * (per_root.x * per_root.y), xz = abs(r.xz) * (per_root.x * per_root.z);
  const R yz = abs(r.yz) * (per_root.y * per_root.z);
  return number<R>(1.00001f) + max(max(xy + xz, xy + yz), xz + yz);
}

/// The kernel with the inverse of these squared radii. Its normalised integral is 315 / (64 pi) sqrt(det A) (1 - q)^3.
template <class R>
PLIANT_HD Kernel<R> make_kernel(const Symmetric<R>& r, const R& gain, float spacing) {
  constexpr float unit_weight = 1.56668147f;
  const R one = number<R>(1);
  const R xx = r.yy * r.zz - r.yz * r.yz, xy = r.xz * r.yz - r.xy * r.zz, xz = r.xy * r.yz - r.xz * r.yy;
  const R determinant = r.xx * xx + r.xy * xy + r.xz * xz;
  const R scale = one / (determinant * number<R>(spacing * spacing));
  const Vec3<R> root{sqrt(r.xx), sqrt(r.yy), sqrt(r.zz)};
  return {{xx * scale, (r.xx * r.zz - r.xz * r.xz) * scale, (r.xx * r.yy - r.xy * r.xy) * scale, xy * scale, xz * scale,
           (r.xy * r.xz - r.xx * r.yz) * scale},
          gain * number<R>(unit_weight) / sqrt(determinant),
          widest_of(r, {one / root.x, one / root.y, one / root.z}),
          {root.x * number<R>(spacing), root.y * number<R>(spacing), root.z * number<R>(spacing)}};
}

}  // namespace pliant::surface
