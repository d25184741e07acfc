// 3 x 3 matrices in double precision.
#pragma once

#include "pliant/vec3.h"

namespace pliant {

/// A 3 x 3 matrix, row by row.
struct Matrix3d {
  double elements[9] = {};
  PLIANT_HD double operator[](int i) const { return elements[i]; }
  PLIANT_HD double& operator[](int i) { return elements[i]; }
};

/// The matrix with these columns.
PLIANT_HD Matrix3d columns(const Vec3<float>& a, const Vec3<float>& b, const Vec3<float>& c) {
  return {{double(a.x), double(b.x), double(c.x), double(a.y), double(b.y), double(c.y), double(a.z), double(b.z),
           double(c.z)}};
}

PLIANT_HD Matrix3d product(const Matrix3d& a, const Matrix3d& b) {
  Matrix3d out;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
  return out;
}

PLIANT_HD double determinant(const Matrix3d& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/// The inverse; all zero if the determinant is zero.
PLIANT_HD Matrix3d inverse(const Matrix3d& m) {
  const double d = determinant(m), s = d == 0 ? 0 : 1 / d;
  return {{s * (m[4] * m[8] - m[5] * m[7]), s * (m[2] * m[7] - m[1] * m[8]), s * (m[1] * m[5] - m[2] * m[4]),
           s * (m[5] * m[6] - m[3] * m[8]), s * (m[0] * m[8] - m[2] * m[6]), s * (m[2] * m[3] - m[0] * m[5]),
           s * (m[3] * m[7] - m[4] * m[6]), s * (m[1] * m[6] - m[0] * m[7]), s * (m[0] * m[4] - m[1] * m[3])}};
}

/// Solves m x = b by Cramer's rule, given the rows of m; not finite if m is singular.
PLIANT_HD Vec3d solve_by_cramer(const Vec3d (&row)[3], const Vec3d& b) {
  const Vec3d minor0 = cross(row[1], row[2]), minor1 = cross(row[2], row[0]), minor2 = cross(row[0], row[1]);
  return (minor0 * b.x + minor1 * b.y + minor2 * b.z) * (1 / dot(row[0], minor0));
}

}  // namespace pliant
