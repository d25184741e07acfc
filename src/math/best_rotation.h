// The rotation nearest to a 3 x 3 matrix.
#pragma once

#include "math/jacobi_rotation.h"
#include "math/matrix.h"
#include "math/quat.h"

namespace pliant {

/// The rotation R that maximises the trace of R^T a, so that R q_i is nearest to r_i where a = sum r_i q_i^T. It is the
/// eigenvector of the largest eigenvalue of a symmetric 4 x 4 matrix (Horn 1987), so it is a rotation and no
/// reflection, whatever a is. The identity for a = 0.
PLIANT_HD Quatd best_rotation(const Matrix3d& a) {
  double size = 0;
  for (int i = 0; i < 9; ++i) size = max(size, abs(a[i]));
  if (!(size > 0)) return {};
  const double s = 1 / size;
  const double xx = a[0] * s, xy = a[3] * s, xz = a[6] * s, yx = a[1] * s, yy = a[4] * s, yz = a[7] * s, zx = a[2] * s,
               zy = a[5] * s, zz = a[8] * s;  // xy: sum of q_x r_y
  Diagonal<4> m;
  const double upper[4][4] = {{xx + yy + zz, yz - zy, zx - xz, xy - yx},
                              {yz - zy, xx - yy - zz, xy + yx, zx + xz},
                              {zx - xz, xy + yx, yy - xx - zz, yz + zy},
                              {xy - yx, zx + xz, yz + zy, zz - xx - yy}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) m.a[i][j] = upper[i][j];
  make_diagonal(m);
  int largest = 0;
  for (int i = 1; i < 4; ++i)
    if (m.a[i][i] > m.a[largest][largest]) largest = i;
  const auto column = [&](int row) { return m.v[row][largest]; };
  return normalise(Quatd{column(1), column(2), column(3), column(0)});
}

}  // namespace pliant
