// Gauss-Seidel in the order of the model's phases: tiles, inter-tile constraints colour by colour, chains if the object
// was compiled with any, and volumes.
#include "solver/drivers/driver.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

void iterate_tiled(Substep& s, bool first) { walk(s, Turn::sweep, {first}); }

}  // namespace pliant
