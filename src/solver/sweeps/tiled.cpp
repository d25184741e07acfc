// Coloured Gauss-Seidel: tile by tile, then the inter-tile constraints colour by colour.
#include "solver/passes.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

void iterate_tiled(Substep& s, bool first) {
  if (!(first && s.sweeps_on_entry)) sweep_tiles(s, first, Order::forward);
  sweep_inter_tile(s, first, Order::forward);
  sweep_volumes(s, first);
}

}  // namespace pliant
