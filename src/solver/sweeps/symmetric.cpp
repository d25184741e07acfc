// Symmetric Gauss-Seidel: a forward pass and a backward pass. This makes the iteration matrix symmetric in the mass
// norm, with real, non-negative eigenvalues, as Chebyshev acceleration requires. Volume constraints act on all points
// of an object and are projected between the two passes.
#include "solver/drivers/driver.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

void iterate_symmetric(Substep& s, bool first) {
  walk(s, Turn::sweep, {first});
  walk(s, Turn::sweep, {false, Order::backward});
}

}  // namespace pliant
