// Moments of a cluster's rest shape: what its linear and quadratic deformations are fitted with.
#pragma once

#include <array>
#include <vector>

#include "model/compiled_clusters.h"

namespace pliant {

/// How many moments a mode fits: none, 3 or 9.
constexpr int moments_of(Cluster::Mode mode) {
  return mode == Cluster::Mode::rigid ? 0 : mode == Cluster::Mode::linear ? 3 : most_moments;
}

inline std::array<double, 6> products_of(const Vec3<double>& q) {
  return {q.x * q.x, q.y * q.y, q.z * q.z, q.x * q.y, q.y * q.z, q.z * q.x};
}

/// Coordinates, then their products less the means.
inline std::array<double, most_moments> moments_at(const Vec3<double>& q, const std::array<double, 6>& means) {
  const std::array<double, 6> p = products_of(q);
  return {q.x,
          q.y,
          q.z,
          p[0] - means[0],
          p[1] - means[1],
          p[2] - means[2],
          p[3] - means[3],
          p[4] - means[4],
          p[5] - means[5]};
}

/// True if the coordinates' part of a matrix of moments, n x n, has a direction of no extent: less than a thousandth of
/// the mean.
bool is_flat(const std::vector<double>& moments, int n);

/// The inverse of a symmetric matrix of moments, n x n, with 1e-10 of its mean diagonal added to the diagonal, so that
/// it exists for flat shapes too.
std::vector<double> inverse_of_moments(std::vector<double> moments, int n);

/// The lower triangular matrix B, n x n, that makes moments orthonormal in the mean over the mass: the identity = B
/// moments B^T. Row k takes out of moment k what those before it fit, so `quadratic` fits only what `linear` leaves.
/// Rows are zero for moments that are combinations of those before them, as some are for few or flat particles.
std::vector<double> orthonormal_basis(const std::vector<double>& moments, int n);

}  // namespace pliant
