// The strain of a deformation apart from its change of volume, for plastic flow.
#pragma once

#include "math/jacobi_rotation.h"
#include "math/matrix.h"

namespace pliant {

/// The logarithmic strain of a deformation gradient F, det F > 0, at constant volume: of F / det(F)^(1/3).
class IsochoricStrain {
 public:
  explicit IsochoricStrain(const Matrix3d& f) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += f[3 * k + i] * f[3 * k + j];
        axes_.a[i][j] = sum;
      }
    make_diagonal(axes_);
    double mean = 0;
    for (int i = 0; i < 3; ++i) {
      strain_[i] = 0.5 * log(max(axes_.a[i][i], 1e-200));
      mean += strain_[i] / 3;
    }
    for (double& strain : strain_) strain -= mean;
  }

  /// von Mises' equivalent strain: log(l) of a bar that is l times as long at constant volume.
  double equivalent() const {
    return sqrt(2.0 / 3 * (strain_[0] * strain_[0] + strain_[1] * strain_[1] + strain_[2] * strain_[2]));
  }

  /// exp(share times the strain), in the axes of the rest shape. Its determinant is 1.
  Matrix3d power(double share) const {
    Matrix3d out;
    for (int k = 0; k < 3; ++k) {
      const double stretch = exp(share * strain_[k]);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) out[3 * i + j] += axes_.v[i][k] * stretch * axes_.v[j][k];
    }
    return out;
  }

 private:
  Diagonal<3> axes_;  // of F^T F
  double strain_[3] = {};
};

/// True if the equivalent strain of F is below `most` for certain, found without its axes. Of the eigenvalues c of F^T
/// F over their mean, |log c_i - log c_j| <= |c_i - c_j| / min c, and min c >= 1 - d, where d^2 is 2/3 of their squared
/// deviator. So the strain is at most d / (2 - 2 d).
inline bool is_surely_below(const Matrix3d& f, double most) {
  double trace = 0, squares = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double c = f[i] * f[j] + f[3 + i] * f[3 + j] + f[6 + i] * f[6 + j];
      squares += c * c;
      trace += i == j ? c : 0;
    }
  const double mean = trace / 3, limit = 2 * most / (1 + 2 * most) * mean;
  return 2.0 / 3 * (squares - 3 * mean * mean) < limit * limit;
}

}  // namespace pliant
