#include "solver/air_kernels.h"

#include "solver/air.h"

namespace pliant {

namespace {

void find_forces(const AirArguments& a, int first, int last) {
  for (int t = first; t < last; ++t) AirOnTriangle{a}(t);
}

void apply_forces_of_air(const AirArguments& a, int first, int last) {
  for (int i = first; i < last; ++i) AirOnParticle{a}(i);
}

}  // namespace

const AirKernels& air_kernels_sequential() {
  static constexpr AirKernels table{&find_forces, &apply_forces_of_air};
  return table;
}

}  // namespace pliant
