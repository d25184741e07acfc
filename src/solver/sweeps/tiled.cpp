// Coloured Gauss-Seidel: every tile by itself, then what straddles tiles, colour by colour.
#include "solver/frame.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

void iterate_tiled(Frame& frame, bool first) {
  if (!(first && frame.swept_on_entry())) frame.sweep_tiles(first, Order::forward);
  frame.sweep_straddlers(first, Order::forward);
  frame.sweep_volumes(first);
}

}  // namespace pliant
