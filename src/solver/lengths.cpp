#include "solver/lengths.h"

#include "model/length_ranges.h"

namespace pliant {

namespace {

void append(void* to, const FoundLength* found, int count) {
  std::vector<FoundLength>& list = *static_cast<std::vector<FoundLength>*>(to);
  list.insert(list.end(), found, found + count);
}

}  // namespace

std::array<int, 2> ends_of(const CompiledObject& object, const FoundLength& found) {
  const Segment& segment = object.segments[found.segment];
  const Pool& pool = object.pools[segment.pool];
  const std::int32_t* index =
      pool.indices.data() + segment.index_offset + std::ptrdiff_t{found.batch} * indices_per_batch(pool, segment);
  return {particle_of(segment, index, 0, found.lane), particle_of(segment, index, 1, found.lane)};
}

void find_long(const CompiledObject& object, const LengthRange& range, const LengthKernels& kernels,
               const LengthQuery& query, std::vector<FoundLength>& found) {
  for_lengths(object, range, [&](const Pool& pool, int first, int last) {
    if (pool.law == Law::compliant || query.velocities != nullptr)
      kernels.find_long(pool, object.segments.data(), first, last, query, append, &found);
  });
}

void find_demanding(const CompiledObject& object, const LengthRange& range, const LengthKernels& kernels,
                    const DemandQuery& query, std::vector<FoundLength>& found) {
  for_lengths(object, range, [&](const Pool& pool, int first, int last) {
    kernels.find_demanding(pool, object.segments.data(), first, last, query, append, &found);
  });
}

}  // namespace pliant
