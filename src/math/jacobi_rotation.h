// Jacobi's method for symmetric matrices (Golub and Van Loan, Matrix Computations, section 8.5).
#pragma once

#include "math/functions.h"

namespace pliant {

/// A symmetric matrix, and the product of the rotations that made it diagonal so far: its columns become the
/// eigenvectors.
template <int n>
struct Diagonal {
  double a[n][n] = {};
  double v[n][n] = {};

  PLIANT_HD Diagonal() {
    for (int i = 0; i < n; ++i) v[i][i] = 1;
  }
};

/// One rotation: makes element (p, q) zero.
template <int n>
PLIANT_HD void rotate_pair(Diagonal<n>& m, int p, int q) {
  const double off = m.a[p][q];
  if (off == 0) return;
  const double tau = (m.a[q][q] - m.a[p][p]) / (2 * off);
  const double t = (tau >= 0 ? 1.0 : -1.0) / (abs(tau) + sqrt(1 + tau * tau));
  const double c = 1 / sqrt(1 + t * t), s = t * c;
  for (int k = 0; k < n; ++k) {
    const double kp = m.a[k][p], kq = m.a[k][q];
    m.a[k][p] = c * kp - s * kq;
    m.a[k][q] = s * kp + c * kq;
  }
  for (int k = 0; k < n; ++k) {
    const double pk = m.a[p][k], qk = m.a[q][k];
    m.a[p][k] = c * pk - s * qk;
    m.a[q][k] = s * pk + c * qk;
    const double vp = m.v[k][p], vq = m.v[k][q];
    m.v[k][p] = c * vp - s * vq;
    m.v[k][q] = s * vp + c * vq;
  }
}

/// Makes all of it diagonal. Each of the sweeps about squares the error; the last changes nothing.
template <int n>
PLIANT_HD void make_diagonal(Diagonal<n>& m) {
  constexpr int sweeps = 7;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int p = 0; p + 1 < n; ++p)
      for (int q = p + 1; q < n; ++q) rotate_pair(m, p, q);
}

}  // namespace pliant
