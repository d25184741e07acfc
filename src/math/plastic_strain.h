// Plastic flow of solids: the share of a strain beyond its yield strain becomes permanent, up to a limit. Common to
// tetrahedra and clusters.
#pragma once

#include "math/isochoric_strain.h"

namespace pliant {

/// Permanent strain beyond which nothing flows, whatever a scene says: bars 4.5 times as long. Longer rest shapes
/// become so flat that rounding decides.
inline constexpr double largest_permanent_strain = 1.5;

/// True if a deformation leaves less than a thousandth in one direction, or inverts: its strain in that direction would
/// be rounding.
inline bool is_pressed_flat(const Matrix3d& f) {
  double squares = 0;
  for (const double element : f.elements) squares += element * element;
  constexpr double thinnest = 1e-3;
  const double mean = squares / 3;
  return !(determinant(f) > thinnest * mean * sqrt(mean));
}

/// Sets `by` to exp(share times the strain of f beyond `yield`), an equivalent strain (IsochoricStrain). False where
/// nothing flows: below the yield strain, and where f is pressed flat, inverted or not finite.
inline bool flow_of(const Matrix3d& f, double yield, double share, Matrix3d& by) {
  if (is_pressed_flat(f) || is_surely_below(f, yield)) return false;
  const IsochoricStrain strain(f);
  const double equivalent = strain.equivalent();
  if (!(equivalent > yield) || !(equivalent < 1e30)) return false;
  by = strain.power(share * (1 - yield / equivalent));
  return true;
}

/// Sets `by` to what multiplies a permanent deformation from the right, so that its strain is at most `most` and
/// largest_permanent_strain. False if it is already.
inline bool limit_of(const Matrix3d& permanent, double most, Matrix3d& by) {
  most = min(most, largest_permanent_strain);
  if (is_surely_below(permanent, most)) return false;
  const IsochoricStrain strain(permanent);
  const double size = strain.equivalent();
  if (!(size > most)) return false;
  by = strain.power(most / size - 1);
  return true;
}

}  // namespace pliant
