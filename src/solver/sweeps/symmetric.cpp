// Symmetric Gauss-Seidel: there and back. What the way there does last the way back does first, so that the iteration as a
// whole has no direction: its matrix is symmetric in the norm of the masses, its eigenvalues are real and none is negative,
// which is what Chebyshev acceleration asks for. Volumes, one constraint over everything, stand at the turning point.
#include "solver/passes.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

void iterate_symmetric(Substep& s, bool first) {
  iterate_tiled(s, first);
  sweep_inter_tile(s, false, Order::backward);
  sweep_tiles(s, false, Order::backward);
}

}  // namespace pliant
