// The matrix of a given determinant that is closest to a 3 x 3 matrix.
#pragma once

#include "math/matrix.h"

namespace pliant {

/// The matrix of determinant d > 0 with the least sum of squared differences from f. f may be flat or inverted.
Matrix3d closest_of_determinant(const Matrix3d& f, double d);

}  // namespace pliant
