// The rotation nearest to a 3 x 3 matrix.
#pragma once

#include "math/functions.h"
#include "math/quat.h"

namespace pliant {

/// A 3 x 3 matrix, row by row.
struct Matrix3d {
  double elements[9] = {};
  PLIANT_HD double operator[](int i) const { return elements[i]; }
  PLIANT_HD double& operator[](int i) { return elements[i]; }
};

namespace detail {

/// A symmetric 4 x 4 matrix and the product of the rotations that made it diagonal so far.
struct Diagonal4 {
  double a[4][4] = {};
  double v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
};

/// One rotation of Jacobi's method: makes element (p, q) zero (Golub and Van Loan, Matrix Computations, section 8.5).
PLIANT_HD void rotate_pair(Diagonal4& m, int p, int q) {
  const double off = m.a[p][q];
  if (off == 0) return;
  const double tau = (m.a[q][q] - m.a[p][p]) / (2 * off);
  const double t = (tau >= 0 ? 1.0 : -1.0) / (abs(tau) + sqrt(1 + tau * tau));
  const double c = 1 / sqrt(1 + t * t), s = t * c;
  for (int k = 0; k < 4; ++k) {
    const double kp = m.a[k][p], kq = m.a[k][q];
    m.a[k][p] = c * kp - s * kq;
    m.a[k][q] = s * kp + c * kq;
  }
  for (int k = 0; k < 4; ++k) {
    const double pk = m.a[p][k], qk = m.a[q][k];
    m.a[p][k] = c * pk - s * qk;
    m.a[q][k] = s * pk + c * qk;
    const double vp = m.v[k][p], vq = m.v[k][q];
    m.v[k][p] = c * vp - s * vq;
    m.v[k][q] = s * vp + c * vq;
  }
}

}  // namespace detail

/// The rotation R that maximises the trace of R^T a, so that R q_i is nearest to r_i where a = sum r_i q_i^T. It is the eigenvector of
/// the largest eigenvalue of a symmetric 4 x 4 matrix (Horn 1987), so it is a rotation and no reflection, whatever a is. The
/// identity for a = 0.
PLIANT_HD Quatd best_rotation(const Matrix3d& a) {
  double size = 0;
  for (int i = 0; i < 9; ++i) size = max(size, abs(a[i]));
  if (!(size > 0)) return {};
  const double s = 1 / size;
  const double xx = a[0] * s, xy = a[3] * s, xz = a[6] * s, yx = a[1] * s, yy = a[4] * s, yz = a[7] * s, zx = a[2] * s,
               zy = a[5] * s, zz = a[8] * s;  // xy: sum of q_x r_y
  detail::Diagonal4 m;
  const double upper[4][4] = {{xx + yy + zz, yz - zy, zx - xz, xy - yx},
                              {yz - zy, xx - yy - zz, xy + yx, zx + xz},
                              {zx - xz, xy + yx, yy - xx - zz, yz + zy},
                              {xy - yx, zx + xz, yz + zy, zz - xx - yy}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) m.a[i][j] = upper[i][j];
  constexpr int sweeps = 7;  // each about squares the error; the last changes nothing
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int p = 0; p < 3; ++p)
      for (int q = p + 1; q < 4; ++q) detail::rotate_pair(m, p, q);
  int largest = 0;
  for (int i = 1; i < 4; ++i)
    if (m.a[i][i] > m.a[largest][largest]) largest = i;
  const auto column = [&](int row) { return m.v[row][largest]; };
  return normalise(Quatd{column(1), column(2), column(3), column(0)});
}

}  // namespace pliant
