// The readable reference: one constraint, one particle at a time, in plain floats, in the order of the schedule. It gives the bits
// of the lanes, which is how they are tested.
#include <cstring>

#include "constraints/all.h"
#include "solver/kernels.h"
#include "solver/project.h"

namespace pliant {

namespace {

template <class T, Law law, bool keeps_multipliers>
void project_lane(const Pool& pool, std::int64_t batch, int lane, const std::int32_t (&particle)[T::size], float* multiplier,
                  const SweepArguments& a) {
  constexpr int fields = static_cast<int>(sizeof(typename T::template Params<float>) / sizeof(float));
  float rest[fields];
  for (int field = 0; field < fields; ++field) rest[field] = pool.row(field, batch)[lane];
  typename T::template Params<float> params;
  std::memcpy(&params, rest, sizeof params);

  Vec3f x[T::size], motion[T::size];
  float w[T::size];
  for (int slot = 0; slot < T::size; ++slot) {
    const Record& p = a.positions[particle[slot]];
    const Record& q = a.predicted[particle[slot]];
    const Record& v = a.velocities[particle[slot]];
    x[slot] = {p.x, p.y, p.z};
    w[slot] = p.w;
    motion[slot] = Vec3f{v.x, v.y, v.z} * a.h + (x[slot] - Vec3f{q.x, q.y, q.z});
  }
  Answer<float> answer{pool.row(fields, batch)[lane], law == Law::damped ? pool.row(fields + 1, batch)[lane] : 0.f,
                       keeps_multipliers && !a.first_pass ? *multiplier : 0.f};
  project<T, law, keeps_multipliers>(x, w, params, motion, answer, a);
  if (keeps_multipliers) *multiplier = answer.multiplier;
  for (int slot = 0; slot < T::size; ++slot) a.positions[particle[slot]] = {x[slot].x, x[slot].y, x[slot].z, w[slot]};
}

template <class T, Law law, bool keeps_multipliers>
void sweep_segment(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment)) {
    const std::int64_t number = segment.first_batch + batch;
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, batch, lane)) continue;
      std::int32_t particle[T::size];
      for (int slot = 0; slot < T::size; ++slot) particle[slot] = particle_of(segment, index, slot, lane);
      float* multiplier = keeps_multipliers ? multipliers + number * batch_width + lane : nullptr;
      project_lane<T, law, keeps_multipliers>(pool, number, lane, particle, multiplier, a);
    }
  }
}

template <class T>
void sweep_type(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  const bool keeps = multipliers != nullptr;
  switch (pool.law) {
    case Law::compliant:
      return keeps ? sweep_segment<T, Law::compliant, true>(pool, segment, multipliers, a)
                   : sweep_segment<T, Law::compliant, false>(pool, segment, multipliers, a);
    case Law::damped:
      return keeps ? sweep_segment<T, Law::damped, true>(pool, segment, multipliers, a)
                   : sweep_segment<T, Law::damped, false>(pool, segment, multipliers, a);
    case Law::pbd:
      return sweep_segment<T, Law::pbd, false>(pool, segment, multipliers, a);
  }
}

void sweep(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& a) {
  for (const Segment* segment = first; segment != last; ++segment) {
    const Pool& pool = pools[segment->pool];
    float* multipliers = a.multipliers != nullptr ? a.multipliers[segment->pool] : nullptr;
    with_type(AllConstraints{}, pool.type,
              [&](auto tag) { sweep_type<typename decltype(tag)::type>(pool, *segment, multipliers, a); });
  }
}

void update(const AdvanceArguments& a) {
  for (int i = a.first; i < a.last; ++i) {
    const Record &x = a.positions[i], &q = a.predicted[i];
    Record& v = a.velocities[i];
    v.x = (v.x + (x.x - q.x) * a.inverse_h) * a.velocity_kept;
    v.y = (v.y + (x.y - q.y) * a.inverse_h) * a.velocity_kept;
    v.z = (v.z + (x.z - q.z) * a.inverse_h) * a.velocity_kept;
  }
}

void predict_component(float& x, float& remainder, float velocity, float h) {
  const float step = remainder + velocity * h;
  const float moved = x + step;
  remainder = step - (moved - x);
  x = moved;
}

void add_point(const Record& p, Bounds& bounds) {
  bounds.low = {min(bounds.low.x, p.x), min(bounds.low.y, p.y), min(bounds.low.z, p.z), 0};
  bounds.high = {max(bounds.high.x, p.x), max(bounds.high.y, p.y), max(bounds.high.z, p.z), 0};
}

void predict(const AdvanceArguments& a, Bounds* bounds) {
  for (int i = a.first; i < a.last; ++i) {
    Record &x = a.positions[i], &r = a.remainders[i], &v = a.velocities[i];
    if (bounds != nullptr) add_point(x, *bounds);
    const bool free = x.w > 0;
    v.x = v.x + select(free, a.gravity_step.x, 0.f);
    v.y = v.y + select(free, a.gravity_step.y, 0.f);
    v.z = v.z + select(free, a.gravity_step.z, 0.f);
    predict_component(x.x, r.x, v.x, a.h);
    predict_component(x.y, r.y, v.y, a.h);
    predict_component(x.z, r.z, v.z, a.h);
    a.predicted[i] = x;
    if (bounds != nullptr) add_point(x, *bounds);
  }
}

void advance(const AdvanceArguments& a, Bounds* bounds) {
  update(a);
  predict(a, bounds);
}

/// The reference looks closely at every particle.
int find_near(const NearQuery& q, std::int32_t* near) {
  for (int i = q.first; i < q.last; ++i) near[i - q.first] = i;
  return q.last - q.first;
}

bool all_finite(const Record* positions, int first, int last) {
  for (int i = first; i < last; ++i) {
    const Record& p = positions[i];
    if (!((p.x - p.x) + (p.y - p.y) + (p.z - p.z) == 0)) return false;
  }
  return true;
}

}  // namespace

const Kernels& kernels_sequential() {
  static constexpr Kernels table{"sequential", &sweep, &all_finite, &update, &predict, &advance, &find_near};
  return table;
}

}  // namespace pliant
