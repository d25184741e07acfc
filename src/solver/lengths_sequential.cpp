// The search for long distances in scalar floats, one constraint after another: the readable reference of
// length_lanes.cpp.
#include "solver/length_kernels.h"
#include "solver/length_of.h"

namespace pliant {

namespace {

Vec3f between(const Record* base, int from, int to) {
  return {base[to].x - base[from].x, base[to].y - base[from].y, base[to].z - base[from].z};
}

/// The length that forces explain [m].
float explained(const Pool& pool, std::int64_t batch, int lane, float multiplier, const Vec3f& across,
                const Vec3f& speed, const LengthQuery& q) {
  const float compliance = pool.row(1, batch)[lane];
  const float elastic = explained_by_force(compliance, multiplier, q.inverse_h2);
  if (pool.law != Law::damped || q.velocities == nullptr) return elastic;
  return elastic + explained_by_damping(across, speed, compliance, pool.row(2, batch)[lane], q.inverse_h2);
}

/// True if the constraint in a lane has a rest length above zero and a free particle.
bool counts(const Pool& pool, const Segment& segment, const std::int32_t* index, int b, int lane,
            const Record* positions) {
  if (!lane_is_valid(segment, b, lane) || !(pool.row(0, std::int64_t{segment.first_batch} + b)[lane] > 0)) return false;
  return positions[particle_of(segment, index, 0, lane)].w > 0 || positions[particle_of(segment, index, 1, lane)].w > 0;
}

void find_long(const Pool& pool, const Segment* segments, int first, int last, const LengthQuery& q,
               FoundLengthCallback found, void* context) {
  const float* multipliers = q.multipliers != nullptr ? q.multipliers[segments[first].pool] : nullptr;
  for (int s = first; s < last; ++s) {
    const std::int32_t* index = pool.indices.data() + segments[s].index_offset;
    for (int b = 0; b < segments[s].batches; ++b, index += indices_per_batch(pool, segments[s])) {
      const std::int64_t batch = std::int64_t{segments[s].first_batch} + b;
      for (int lane = 0; lane < batch_width; ++lane) {
        if (!counts(pool, segments[s], index, b, lane, q.positions)) continue;
        const int from = particle_of(segments[s], index, 0, lane), to = particle_of(segments[s], index, 1, lane);
        Vec3f across = between(q.positions, from, to);
        if (q.displacements != nullptr) across += between(q.displacements, from, to);
        const Vec3f speed = q.velocities != nullptr ? between(q.velocities, from, to) : Vec3f{};
        const float rest = pool.row(0, batch)[lane];
        const float by =
            multipliers == nullptr
                ? overstretch(across, rest)
                : overstretch(across, rest,
                              explained(pool, batch, lane, multipliers[batch * batch_width + lane], across, speed, q));
        const FoundLength one{s, b, lane, by};
        if (by > q.above) found(context, &one, 1);
      }
    }
  }
}

void find_demanding(const Pool& pool, const Segment* segments, int first, int last, const DemandQuery& q,
                    FoundLengthCallback found, void* context) {
  for (int s = first; s < last; ++s) {
    const std::int32_t* index = pool.indices.data() + segments[s].index_offset;
    for (int b = 0; b < segments[s].batches; ++b, index += indices_per_batch(pool, segments[s])) {
      for (int lane = 0; lane < batch_width; ++lane) {
        const float rest = pool.row(0, std::int64_t{segments[s].first_batch} + b)[lane];
        if (!counts(pool, segments[s], index, b, lane, q.positions)) continue;
        const int from = particle_of(segments[s], index, 0, lane), to = particle_of(segments[s], index, 1, lane);
        const float substeps =
            demand(between(q.positions, from, to), between(q.velocities, from, to), rest, q.by_stretch, q.by_turn);
        const FoundLength one{s, b, lane, substeps};
        if (substeps > q.above) found(context, &one, 1);
      }
    }
  }
}

}  // namespace

const LengthKernels& length_kernels_sequential() {
  static constexpr LengthKernels table{&find_long, &find_demanding};
  return table;
}

}  // namespace pliant
