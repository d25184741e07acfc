// Which flat sheets have hinges although they could bend as a whole (model/sheet_bending.h).
#pragma once

#include "pliant/scene.h"

namespace pliant {

/// True if edges are so long that a sheet bends by its own weight within two: on average longer than 0.45 of
/// (B / (rho g))^(1/3), the overhang that bends by its own weight. Such cloth folds sharply at single edges, where the
/// energy of the whole sheet, which is for small angles, is too soft. Depends on neither the time step nor the number
/// of particles. `gravity`: its magnitude; less than 9.81 is taken as that, since weightless cloth folds sharply, too
/// [m/s^2].
bool has_long_edges(const Object& object, double gravity);

}  // namespace pliant
