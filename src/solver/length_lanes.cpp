// The search for long distances in sixteen SIMD lanes, compiled per instruction set level under the rules of lanes.cpp.
#include "math/wide.h"
#include "solver/length_kernels.h"
#include "solver/length_of.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

PLIANT_HD Registers load_slot(const Record* base, const Segment& segment, const std::int32_t* index, int slot) {
  const std::int32_t* at = index + indices_before(segment.runs, slot);
  return (segment.runs >> slot & 1) != 0 ? load_runs(base, at) : load_indexed(base, at);
}

/// The difference between the records of both ends.
PLIANT_HD Registers between(const Record* base, const Segment& segment, const std::int32_t* index) {
  return load_slot(base, segment, index, 1) - load_slot(base, segment, index, 0);
}

/// The overstretch of a batch, by lane.
PLIANT_HD Wide overstretch_of(const Pool& pool, const Segment& segment, std::int64_t batch, const std::int32_t* index,
                              const float* multipliers, const LengthQuery& q) {
  const Wide rest = load_wide(pool.row(0, batch));
  Registers apart = between(q.positions, segment, index);
  if (q.displacements != nullptr) apart = apart + between(q.displacements, segment, index);
  const Vec3<Wide> across = from_registers(apart).position;
  if (multipliers == nullptr) return overstretch(across, rest);
  return overstretch(across, rest, load_wide(pool.row(1, batch)), load_wide(multipliers + batch * batch_width),
                     Wide(q.inverse_h2));
}

void find_long(const Pool& pool, const Segment* segments, int first, int last, const LengthQuery& q,
               FoundLengthCallback found, void* context) {
  const float* multipliers = q.multipliers != nullptr ? q.multipliers[segments[first].pool] : nullptr;
  const Wide above(q.above);
  for (int s = first; s < last; ++s) {
    const Segment& segment = segments[s];
    const std::int32_t* index = pool.indices.data() + segment.index_offset;
    for (int b = 0; b < segment.batches; ++b, index += indices_before(segment.runs, 2)) {
      const std::int64_t batch = std::int64_t{segment.first_batch} + b;
      const Wide by = overstretch_of(pool, segment, batch, index, multipliers, q);
      const WideMask beyond = by > above;
      if (!any(beyond)) continue;
      float lanes[batch_width], rest[batch_width];
      store_wide(lanes, by);
      store_wide(rest, load_wide(pool.row(0, batch)));
      for (int lane = 0; lane < batch_width; ++lane)
        if (lanes[lane] > q.above && rest[lane] > 0 && lane_is_valid(segment, b, lane))
          found(context, {s, b, lane, lanes[lane]});
    }
  }
}

void find_demanding(const Pool& pool, const Segment* segments, int first, int last, const DemandQuery& q,
                    FoundLengthCallback found, void* context) {
  const Wide above(q.above), by_stretch(q.by_stretch), by_turn(q.by_turn);
  for (int s = first; s < last; ++s) {
    const Segment& segment = segments[s];
    const std::int32_t* index = pool.indices.data() + segment.index_offset;
    for (int b = 0; b < segment.batches; ++b, index += indices_before(segment.runs, 2)) {
      const std::int64_t batch = std::int64_t{segment.first_batch} + b;
      const Wide rests = load_wide(pool.row(0, batch));
      const Wide substeps =
          demand(from_registers(between(q.positions, segment, index)).position,
                 from_registers(between(q.velocities, segment, index)).position, rests, by_stretch, by_turn);
      if (!any(substeps > above)) continue;
      float lanes[batch_width], rest[batch_width];
      store_wide(lanes, substeps);
      store_wide(rest, rests);
      for (int lane = 0; lane < batch_width; ++lane)
        if (lanes[lane] > q.above && rest[lane] > 0 && lane_is_valid(segment, b, lane))
          found(context, {s, b, lane, lanes[lane]});
    }
  }
}

}  // namespace
}  // namespace PLIANT_ISA

const LengthKernels& PLIANT_OF_LEVEL(length_kernels)() {
  static constexpr LengthKernels table{&find_long, &find_demanding};
  return table;
}

}  // namespace pliant
