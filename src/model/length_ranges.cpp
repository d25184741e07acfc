#include "model/length_ranges.h"

namespace pliant {

namespace {

/// Least number of batches of a range: a smaller one is done before another thread wakes up.
constexpr int fewest_batches = 128;

/// Counts the constraints with a rest length above zero of which a particle is free.
std::int64_t count_free(const CompiledObject& object, const Pool& pool, const Segment& segment) {
  std::int64_t count = 0;
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment)) {
    const float* rest = pool.row(0, std::int64_t{segment.first_batch} + batch);
    for (int lane = 0; lane < batch_width; ++lane) {
      const bool is_free = object.positions[particle_of(segment, index, 0, lane)].w > 0 ||
                           object.positions[particle_of(segment, index, 1, lane)].w > 0;
      count += is_free && rest[lane] > 0 && lane_is_valid(segment, batch, lane) ? 1 : 0;
    }
  }
  return count;
}

}  // namespace

std::vector<LengthRange> find_length_ranges(const CompiledObject& object) {
  std::vector<LengthRange> ranges;
  for (int s = 0; s < static_cast<int>(object.segments.size()); ++s) {
    const Segment& segment = object.segments[s];
    if (!object.pools[segment.pool].is_length) continue;
    if (ranges.empty() || ranges.back().batches >= fewest_batches) ranges.push_back({s, s, 0, 0});
    ranges.back().last = s + 1;
    ranges.back().batches += segment.batches;
  }
  for (LengthRange& range : ranges)
    for_lengths(object, range, [&](const Pool& pool, int first, int last) {
      for (int s = first; s < last; ++s) range.constraints += count_free(object, pool, object.segments[s]);
    });
  return ranges;
}

}  // namespace pliant
