// Symmetric Gauss-Seidel: there and back. What the way there does last the way back does first, so that the iteration as a
// whole has no direction: its matrix is symmetric in the norm of the masses, its eigenvalues are real and none is negative,
// which is what Chebyshev acceleration asks for. Volumes, one constraint over everything, stand at the turning point.
#include "solver/frame.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

void iterate_symmetric(Frame& frame, bool first) {
  iterate_tiled(frame, first);
  frame.sweep_straddlers(false, Order::backward);
  frame.sweep_tiles(false, Order::backward);
}

}  // namespace pliant
