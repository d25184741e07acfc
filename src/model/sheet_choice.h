// Which flat sheets have hinges although they could bend as a whole, and what others lose by it
// (model/sheet_bending.h).
#pragma once

#include "pliant/scene.h"

namespace pliant {

/// True if edges are so long that a sheet bends by its own weight within two: on average longer than 0.45 of
/// (B / (rho g))^(1/3), the overhang that bends by its own weight. Such cloth folds sharply at single edges, where the
/// energy of the whole sheet, which is for small angles, is too soft. Depends on neither the time step nor the number
/// of particles. `gravity`: its magnitude; less than 9.81 is taken as that, since weightless cloth folds sharply, too
/// [m/s^2].
bool has_long_edges(const Object& object, double gravity);

/// h^2 B / (rho e^4) beyond which floats of M + h^2 K have no room for M, so that a sheet keeps hinges: l / e = 18,
/// measured up to 16.
inline constexpr double most_stiffness_of_sheets = 1e5;

/// By how much a rest shape that is taken as flat is bowed: the farthest vertex from the plane of its piece [m]. 0 if
/// the offsets from it are those of rounding, which neighbours do not share, or below a thousandth of an edge.
double bow_of_sheet(const Object& object);

}  // namespace pliant
