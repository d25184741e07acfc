// Which tetrahedra are about as large.
#pragma once

#include <cmath>

namespace pliant {

/// The number of a class of volumes, by powers of the square root of two. Constraints of a group have one damping, so
/// what is damped in proportion to its stiffness has a group for each class.
inline int size_class(double volume) {
  int exponent = 0;
  const double mantissa = std::frexp(volume, &exponent);
  return 2 * exponent + (mantissa >= 0.70710678118654752 ? 1 : 0);
}

}  // namespace pliant
