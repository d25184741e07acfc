// Gauss-Seidel in the order of the model's phases: tile by tile, then the inter-tile constraints colour by colour, chains where the
// objects have any, volumes.
#include "solver/drivers/driver.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

void iterate_tiled(Substep& s, bool first) { walk(s, Turn::sweep, {first}); }

}  // namespace pliant
