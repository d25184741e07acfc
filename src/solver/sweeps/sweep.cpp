#include "solver/sweeps/sweep.h"

#include "model/model.h"
#include "solver/sweeps/jacobi.h"
#include "solver/sweeps/multigrid.h"

namespace pliant {

namespace {

template <class Scratch>
std::unique_ptr<SweepScratch> make() {
  return std::make_unique<Scratch>();
}

}  // namespace

bool SweepSetup::has(int object) const {
  const CompiledObject& of = model.objects[object];
  return of.sweep == sweep && !of.is_collider && of.particles > 0;
}

const SweepMethod& sweep_method(Sweep sweep) {
  static constexpr SweepMethod tiled{true, 1, nullptr, &iterate_tiled}, symmetric{true, 2, nullptr, &iterate_symmetric},
      jacobi{false, 1, &make<JacobiScratch>, &iterate_jacobi}, chains{true, 1, nullptr, &iterate_tiled},
      multigrid{false, 2, &make<MultigridScratch>, &iterate_multigrid};
  switch (sweep) {
    case Sweep::symmetric:
      return symmetric;
    case Sweep::jacobi:
      return jacobi;
    case Sweep::chains:
    case Sweep::tethered_chains:
      return chains;
    case Sweep::multigrid:
      return multigrid;
    default:
      return tiled;  // also `sequential` and `natural`, which differ in kernels and schedule only
  }
}

}  // namespace pliant
