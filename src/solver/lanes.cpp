// The sweep over segments of any type: calls the sweep of each segment's type (sweep_in_lanes.h) of the level that is
// being compiled.
#include "constraints/in_lanes.h"
#include "math/levels.h"
#include "solver/kernels.h"
#include "solver/sweep_of_type.h"

namespace pliant {
inline namespace PLIANT_LEVEL_ISA {
namespace {

template <class... Types>
void sweep_any(TypeList<Types...>, const Pool& pool, const Segment& segment, float* multipliers,
               const SweepArguments& a) {
  using Function = void (*)(const Pool&, const Segment&, float*, const SweepArguments&);
  static_assert((in_lanes<Types> && ...), "other types are projected one at a time");
  static constexpr Function table[] = {&SweepOf<Types>::sweep...};
  table[pool.type](pool, segment, multipliers, a);
}

void sweep(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& a) {
  for (const Segment* segment = first; segment != last; ++segment) {
    float* multipliers = a.multipliers != nullptr ? a.multipliers[segment->pool] : nullptr;
    sweep_any(LaneConstraints{}, pools[segment->pool], *segment, multipliers, a);
  }
}

}  // namespace
}  // namespace PLIANT_LEVEL_ISA

const SweepKernels& PLIANT_OF_LEVEL(sweep_kernels)() {
  static constexpr SweepKernels table{&sweep};
  return table;
}

}  // namespace pliant
