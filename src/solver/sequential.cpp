// The readable reference: one constraint or particle at a time, in plain floats, in the order of the schedule. Tests
// require that the SIMD kernels give the same bits.
#include <algorithm>
#include <cstring>

#include "constraints/all.h"
#include "solver/kernels.h"
#include "solver/points.h"
#include "solver/project.h"

namespace pliant {

namespace {

/// The position of a constraint: pool, batch, lane.
struct Place {
  int pool;
  std::int64_t batch;
  int lane;
};

/// Where a general sweep stores one constraint's corrections; those of the next slot follow sixteen records later.
/// Null: nowhere.
Record* correction_of(const Pool& pool, const SweepArguments& a, int pool_number, std::int64_t batch, int lane) {
  if (a.corrections == nullptr) return nullptr;
  return a.corrections[pool_number] + batch * pool.stencil * batch_width + correction_place(lane);
}

template <class T, Law law, bool keeps_multipliers, bool general, bool keeps_energy>
void project_lane(const Pool& pool, const Place& at, const std::int32_t (&particle)[slot_count<T>], float* multiplier,
                  const SweepArguments& a) {
  const std::int64_t batch = at.batch;
  const int lane = at.lane;
  constexpr int fields = static_cast<int>(sizeof(typename T::template Params<float>) / sizeof(float));
  float rest[fields];
  for (int field = 0; field < fields; ++field) rest[field] = pool.row(field, batch)[lane];
  typename T::template Params<float> params;
  std::memcpy(&params, rest, sizeof params);

  Vec3f x[slot_count<T>], motion[slot_count<T>], coast[slot_count<T>], correction[slot_count<T>];
  float w[slot_count<T>];
  const Record &origin = a.positions[particle[0]], first = a.displacements[particle[0]];
  for (int slot = 0; slot < slot_count<T>; ++slot) {
    const Record& p = a.positions[particle[slot]];
    const Record &d = a.displacements[particle[slot]], &r = a.remainders[particle[slot]];
    x[slot] = slot == 0 ? Vec3f{0, 0, 0}
                        : Vec3f{((p.x - origin.x) + d.x) - first.x, ((p.y - origin.y) + d.y) - first.y,
                                ((p.z - origin.z) + d.z) - first.z};
    w[slot] = p.w;
    motion[slot] = {d.x - r.x, d.y - r.y, d.z - r.z};
    if constexpr (keeps_energy) coast[slot] = coast_of(a, particle[slot]);
  }
  ConstraintResponse<float> response{pool.row(fields, batch)[lane],
                                     law == Law::damped && pool.law == law ? pool.row(fields + 1, batch)[lane] : 0.f,
                                     keeps_multipliers && !a.first_pass ? *multiplier : 0.f};
  response.is_damped = pool.law == Law::damped;
  if (general && a.shares != nullptr) response.share = a.shares[at.pool][batch * batch_width + lane];
  project<T, law, keeps_multipliers, general>(x, w, params, motion, response, a, correction,
                                              keeps_energy ? coast : nullptr);
  if (keeps_multipliers) *multiplier = response.multiplier;
  Record* aside = general ? correction_of(pool, a, at.pool, batch, lane) : nullptr;
  for (int slot = 0; slot < slot_count<T>; ++slot) {
    if (aside != nullptr) {
      aside[slot * batch_width] = {correction[slot].x, correction[slot].y, correction[slot].z, 0};
      continue;
    }
    Record& d = a.displacements[particle[slot]];
    d = {d.x + correction[slot].x, d.y + correction[slot].y, d.z + correction[slot].z, 0};
  }
}

template <class T, Law law, bool keeps_multipliers, bool general, bool keeps_energy = false>
void sweep_segment(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment)) {
    const std::int64_t number = segment.first_batch + batch;
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, batch, lane)) continue;
      std::int32_t particle[slot_count<T>];
      for (int slot = 0; slot < slot_count<T>; ++slot) particle[slot] = particle_of(segment, index, slot, lane);
      float* multiplier = keeps_multipliers ? multipliers + number * batch_width + lane : nullptr;
      project_lane<T, law, keeps_multipliers, general, keeps_energy>(pool, {segment.pool, number, lane}, particle,
                                                                     multiplier, a);
    }
  }
}

template <class T, bool general>
void sweep_type(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  const bool keeps = multipliers != nullptr;
  if (a.keeps_energy && pool.law != Law::pbd) {  // a compliant pool has no damping
    return keeps ? sweep_segment<T, Law::damped, true, general, true>(pool, segment, multipliers, a)
                 : sweep_segment<T, Law::damped, false, general, true>(pool, segment, multipliers, a);
  }
  switch (pool.law) {
    case Law::compliant:
      return keeps ? sweep_segment<T, Law::compliant, true, general>(pool, segment, multipliers, a)
                   : sweep_segment<T, Law::compliant, false, general>(pool, segment, multipliers, a);
    case Law::damped:
      return keeps ? sweep_segment<T, Law::damped, true, general>(pool, segment, multipliers, a)
                   : sweep_segment<T, Law::damped, false, general>(pool, segment, multipliers, a);
    case Law::pbd:
      return sweep_segment<T, Law::pbd, false, general>(pool, segment, multipliers, a);
  }
}

template <bool general>
void sweep(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& a) {
  for (const Segment* segment = first; segment != last; ++segment) {
    const Pool& pool = pools[segment->pool];
    float* multipliers = a.multipliers != nullptr ? a.multipliers[segment->pool] : nullptr;
    with_type(AllConstraints{}, pool.type, [&](auto tag) {
      using T = typename decltype(tag)::type;
      if constexpr (in_lanes<T>) sweep_type<T, general>(pool, *segment, multipliers, a);
    });
  }
}

void update(const AdvanceArguments& a) {
  const UpdatePoint update_point{a};
  for (int i = a.first; i < a.last; ++i) update_point(i);
}

void add_point(const Record& p, PointBounds& bounds) {
  bounds.low = {min(bounds.low.x, p.x), min(bounds.low.y, p.y), min(bounds.low.z, p.z), 0};
  bounds.high = {max(bounds.high.x, p.x), max(bounds.high.y, p.y), max(bounds.high.z, p.z), 0};
}

void predict(const AdvanceArguments& a, PointBounds* bounds) {
  const PredictPoint predict_point{a};
  for (int i = a.first; i < a.last; ++i) {
    predict_point(i);
    if (bounds == nullptr) continue;
    const Record &x = a.positions[i], &d = a.displacements[i];
    add_point(x, *bounds);
    add_point({x.x + d.x, x.y + d.y, x.z + d.z, 0}, *bounds);
  }
}

void advance(const AdvanceArguments& a, PointBounds* bounds) {
  update(a);
  predict(a, bounds);
}

/// Reports all particles of the range as near: the scalar reference does not cull.
int find_near(const NearQuery& q, std::int32_t* near) {
  for (int i = q.first; i < q.last; ++i) near[i - q.first] = i;
  return q.last - q.first;
}

bool all_finite(const Record* records, int first, int last) {
  return std::all_of(records + first, records + last, [](const Record& p) { return is_finite(p); });
}

}  // namespace

void sweep_general(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& a) {
  sweep<true>(pools, first, last, a);
}

const SweepKernels& sweep_kernels_sequential() {
  static constexpr SweepKernels table{&sweep<false>};
  return table;
}

const StepKernels& step_kernels_sequential() {
  static constexpr StepKernels table{&all_finite, &update, &predict, &advance, &find_near};
  return table;
}

}  // namespace pliant
