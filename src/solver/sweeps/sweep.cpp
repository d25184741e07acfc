#include "solver/sweeps/sweep.h"

namespace pliant {

const SweepMethod& sweep_method(Sweep sweep) {
  static constexpr SweepMethod tiled{true, 1, &iterate_tiled}, symmetric{true, 2, &iterate_symmetric},
      jacobi{false, 1, &iterate_jacobi}, chains{true, 1, &iterate_chains}, multigrid{false, 2, &iterate_multigrid};
  switch (sweep) {
    case Sweep::symmetric:
      return symmetric;
    case Sweep::jacobi:
      return jacobi;
    case Sweep::chains:
      return chains;
    case Sweep::multigrid:
      return multigrid;
    default:
      return tiled;  // `sequential` and `natural` too: they differ in kernels and in schedule
  }
}

}  // namespace pliant
