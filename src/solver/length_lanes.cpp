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

/// Distances of a batch, by lane.
struct Lengths {
  Vec3<Wide> across;
  Wide rest;
};

Lengths lengths_of(const Pool& pool, const Segment& segment, std::int64_t batch, const std::int32_t* index,
                   const LengthQuery& q) {
  Registers apart = between(q.positions, segment, index);
  if (q.displacements != nullptr) apart = apart + between(q.displacements, segment, index);
  return {from_registers(apart).position, load_wide(pool.row(0, batch))};
}

/// The length that forces explain, by lane.
Wide explained(const Pool& pool, const Segment& segment, std::int64_t batch, const std::int32_t* index,
               const float* multipliers, const Vec3<Wide>& across, const LengthQuery& q) {
  const Wide compliance = load_wide(pool.row(1, batch));
  const Wide elastic = explained_by_force(compliance, load_wide(multipliers + batch * batch_width), Wide(q.inverse_h2));
  if (pool.law != Law::damped || q.velocities == nullptr) return elastic;
  const Vec3<Wide> speed = from_registers(between(q.velocities, segment, index)).position;
  return elastic + explained_by_damping(across, speed, compliance, load_wide(pool.row(2, batch)));
}

/// Reports the lanes of a batch with values above `above`.
void report(const Pool& pool, const Segment& segment, int s, int b, const Wide& values, float above,
            FoundLengthCallback found, void* context) {
  float lanes[batch_width], rest[batch_width];
  store_wide(lanes, values);
  store_wide(rest, load_wide(pool.row(0, std::int64_t{segment.first_batch} + b)));
  for (int lane = 0; lane < batch_width; ++lane)
    if (lanes[lane] > above && rest[lane] > 0 && lane_is_valid(segment, b, lane)) found(context, {s, b, lane, lanes[lane]});
}

/// Most batches have no long constraint; comparing squares finds these without a square root and a division.
void find_long(const Pool& pool, const Segment* segments, int first, int last, const LengthQuery& q,
               FoundLengthCallback found, void* context) {
  const float* multipliers = q.multipliers != nullptr ? q.multipliers[segments[first].pool] : nullptr;
  const Wide above(q.above);
  for (int s = first; s < last; ++s) {
    const Segment& segment = segments[s];
    const std::int32_t* index = pool.indices.data() + segment.index_offset;
    for (int b = 0; b < segment.batches; ++b, index += indices_before(segment.runs, 2)) {
      const std::int64_t batch = std::int64_t{segment.first_batch} + b;
      const Lengths of = lengths_of(pool, segment, batch, index, q);
      const Wide by_force =
          multipliers == nullptr ? Wide(0.f) : explained(pool, segment, batch, index, multipliers, of.across, q);
      if (!any(length_squared(of.across) >= least_squared(of.rest, above, by_force))) continue;
      const Wide by = multipliers == nullptr ? overstretch(of.across, of.rest) : overstretch(of.across, of.rest, by_force);
      if (any(by > above)) report(pool, segment, s, b, by, q.above, found, context);
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
      if (any(substeps > above)) report(pool, segment, s, b, substeps, q.above, found, context);
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
