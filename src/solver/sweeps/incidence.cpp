#include "solver/sweeps/incidence.h"

#include <algorithm>
#include <limits>

#include "pliant/error.h"
#include "solver/kernels.h"

namespace pliant {

namespace {

/// Calls visit(pool index, batch, lane, the batch's particle indices, segment) for every constraint.
template <class Visit>
void for_constraints(const CompiledObject& object, const Visit& visit) {
  for (const Segment& segment : object.segments) {
    const Pool& pool = object.pools[segment.pool];
    if (!pool.in_lanes) continue;
    const std::int32_t* index = pool.indices.data() + segment.index_offset;
    for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment)) {
      for (int lane = 0; lane < batch_width; ++lane) {
        if (lane_is_valid(segment, batch, lane)) visit(segment, std::int64_t{segment.first_batch} + batch, lane, index);
      }
    }
  }
}

}  // namespace

Incidence make_incidence(const CompiledObject& object) {
  Incidence incidence;
  incidence.pool_begin.push_back(0);
  for (const Pool& pool : object.pools) {
    incidence.pool_begin.push_back(incidence.pool_begin.back() +
                                   std::int64_t{pool.batches} * pool.stencil * batch_width);
  }
  if (incidence.pool_begin.back() > std::numeric_limits<std::int32_t>::max()) {
    throw Error({.object = object.name}, "has too many constraints for a Jacobi sweep",
                "cut it in two, or use another sweep");
  }
  incidence.begin.assign(static_cast<std::size_t>(object.particles) + 1, 0);
  for_constraints(object, [&](const Segment& segment, std::int64_t, int lane, const std::int32_t* index) {
    for (int slot = 0; slot < object.pools[segment.pool].stencil; ++slot)
      ++incidence.begin[static_cast<std::size_t>(particle_of(segment, index, slot, lane)) + 1];
  });
  for (int p = 0; p < object.particles; ++p) incidence.begin[p + 1] += incidence.begin[p];
  incidence.records.resize(incidence.begin.back());
  std::vector<std::int32_t> next(incidence.begin.begin(), incidence.begin.end() - 1);
  for_constraints(object, [&](const Segment& segment, std::int64_t batch, int lane, const std::int32_t* index) {
    const int size = object.pools[segment.pool].stencil;
    for (int slot = 0; slot < size; ++slot) {
      const std::int64_t record =
          incidence.pool_begin[segment.pool] + (batch * size + slot) * batch_width + correction_place(lane);
      incidence.records[next[particle_of(segment, index, slot, lane)]++] = static_cast<std::int32_t>(record);
    }
  });
  for (int p = 0; p < object.particles; ++p)
    std::sort(incidence.records.begin() + incidence.begin[p], incidence.records.begin() + incidence.begin[p + 1]);
  return incidence;
}

std::vector<AlignedVector<float>> averaging_shares(const CompiledObject& object, const Incidence& incidence) {
  std::vector<AlignedVector<float>> shares;
  shares.reserve(object.pools.size());
  for (const Pool& pool : object.pools) shares.emplace_back(static_cast<std::size_t>(pool.batches) * batch_width, 1.f);
  for_constraints(object, [&](const Segment& segment, std::int64_t batch, int lane, const std::int32_t* index) {
    double whole = 0, shared = 0;
    for (int slot = 0; slot < object.pools[segment.pool].stencil; ++slot) {
      const int particle = particle_of(segment, index, slot, lane);
      const double w = static_cast<double>(object.positions[particle].w);
      whole += w;
      shared += w / incidence.count(particle);
    }
    if (whole > 0) shares[segment.pool][batch * batch_width + lane] = static_cast<float>(shared / whole);
  });
  return shares;
}

}  // namespace pliant
