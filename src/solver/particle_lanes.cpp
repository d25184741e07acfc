// Four or sixteen particles at a time, compiled once for each instruction set level under the rules of lanes.cpp.
#include "math/unroll.h"
#include "math/wide.h"
#include "solver/kernels.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

PLIANT_HD const float* floats(const Record* r) { return &r->x; }
PLIANT_HD float* floats(Record* r) { return &r->x; }

/// Each record's w, broadcast to its four components.
PLIANT_HD Wide spread_w(const Wide& a) {
  Wide r;
  PLIANT_EACH_PART(r.part[i] = PLIANT_SHUFFLE(a.part[i], a.part[i], 3, 3, 7, 7))
  return r;
}

/// Four records with the same (x, y, z, 0).
PLIANT_HD Wide spread(const Vec3f& v) {
  float all[wide_width];
  for (int i = 0; i < wide_width; i += 4) {
    all[i] = v.x;
    all[i + 1] = v.y;
    all[i + 2] = v.z;
    all[i + 3] = 0;
  }
  return load_wide(all);
}

struct FourParticles {
  Wide position, displacement, remainder, velocity;
};

/// Gravity for those of the four particles that have finite mass, zero for the others.
PLIANT_HD Wide gravity_on(const FourParticles& p, const Wide& gravity) {
  return select(spread_w(p.position) > Wide(0.f), gravity, Wide(0.f));
}

/// The three gravity terms of AdvanceArguments, each in four records.
struct WideGravity {
  Wide finished, begun, settled;
  PLIANT_HD explicit WideGravity(const AdvanceArguments& a)
      : finished(spread(a.gravity_finished)), begun(spread(a.gravity_begun)), settled(spread(a.gravity_settled)) {}
};

PLIANT_HD void update_four(FourParticles& p, const WideGravity& gravity, const AdvanceArguments& a) {
  const Wide predicted = p.remainder + (p.velocity + gravity_on(p, gravity.finished)) * Wide(a.h);
  p.velocity = (p.velocity + (p.displacement - predicted) * Wide(a.inverse_h)) * Wide(a.velocity_kept) +
               gravity_on(p, gravity.settled);
  const Wide moved = p.position + p.displacement;
  p.remainder = p.displacement - (moved - p.position);
  p.position = moved;
}

PLIANT_HD void predict_four(FourParticles& p, const WideGravity& gravity, const AdvanceArguments& a) {
  p.displacement = p.remainder + (p.velocity + gravity_on(p, gravity.begun)) * Wide(a.h);
}

PLIANT_HD FourParticles load_four(const AdvanceArguments& a, int i) {
  return {load_wide(floats(a.positions + i)), load_wide(floats(a.displacements + i)),
          load_wide(floats(a.remainders + i)), load_wide(floats(a.velocities + i))};
}

PLIANT_HD void store_four(const AdvanceArguments& a, int i, const FourParticles& p) {
  store_wide(floats(a.positions + i), p.position);
  store_wide(floats(a.displacements + i), p.displacement);
  store_wide(floats(a.remainders + i), p.remainder);
  store_wide(floats(a.velocities + i), p.velocity);
}

/// The last one to three particles of a range, in buffers padded to four.
struct Tail {
  Record positions[4], displacements[4], remainders[4], velocities[4];
  AdvanceArguments arguments;
  int first, count;

  PLIANT_HD Tail(const AdvanceArguments& a, int from) : arguments(a), first(from), count(a.last - from) {
    for (int i = 0; i < 4; ++i) {
      const int at = from + (i < count ? i : count - 1);
      positions[i] = a.positions[at];
      displacements[i] = a.displacements[at];
      remainders[i] = a.remainders[at];
      velocities[i] = a.velocities[at];
    }
    arguments.positions = positions;
    arguments.displacements = displacements;
    arguments.remainders = remainders;
    arguments.velocities = velocities;
  }
  PLIANT_HD void write_back(const AdvanceArguments& a) const {
    for (int i = 0; i < count; ++i) {
      a.positions[first + i] = positions[i];
      a.displacements[first + i] = displacements[i];
      a.remainders[first + i] = remainders[i];
      a.velocities[first + i] = velocities[i];
    }
  }
};

struct WideBounds {
  Wide low{3e38f}, high{-3e38f};
};

PLIANT_HD void add_bounds(const WideBounds& wide, PointBounds& bounds) {
  float low[wide_width], high[wide_width];
  store_wide(low, wide.low);
  store_wide(high, wide.high);
  for (int i = 0; i < wide_width; i += 4) {
    Record &l = bounds.low, &h = bounds.high;
    l = {pliant::min(l.x, low[i]), pliant::min(l.y, low[i + 1]), pliant::min(l.z, low[i + 2]), 0};
    h = {pliant::max(h.x, high[i]), pliant::max(h.y, high[i + 1]), pliant::max(h.z, high[i + 2]), 0};
  }
}

template <bool updates, bool predicts, bool bounded>
PLIANT_HD void advance_at(const AdvanceArguments& a, int i, const WideGravity& gravity, WideBounds& bounds) {
  FourParticles p = load_four(a, i);
  if constexpr (updates) update_four(p, gravity, a);
  if constexpr (predicts) {
    predict_four(p, gravity, a);
  }
  if constexpr (bounded) {
    const Wide end = p.position + p.displacement;
    bounds.low = min(bounds.low, min(p.position, end));
    bounds.high = max(bounds.high, max(p.position, end));
  }
  store_four(a, i, p);
}

template <bool updates, bool predicts, bool bounded>
PLIANT_HD void advance_all(const AdvanceArguments& a, WideBounds& bounds) {
  const WideGravity gravity(a);
  int i = a.first;
  for (; i + 4 <= a.last; i += 4) advance_at<updates, predicts, bounded>(a, i, gravity, bounds);
  if (i < a.last) {
    Tail tail(a, i);
    advance_at<updates, predicts, bounded>(tail.arguments, 0, gravity, bounds);
    tail.write_back(a);
  }
}

/// Predicts all particles, after their update if `updates`, and finds the bounds of their motion unless `bounds` is
/// null.
template <bool updates>
PLIANT_HD void predict_all(const AdvanceArguments& a, PointBounds* bounds) {
  WideBounds wide;
  if (bounds == nullptr) return advance_all<updates, true, false>(a, wide);
  advance_all<updates, true, true>(a, wide);
  add_bounds(wide, *bounds);
}

void update(const AdvanceArguments& a) {
  WideBounds none;
  advance_all<true, false, false>(a, none);
}
void predict(const AdvanceArguments& a, PointBounds* bounds) { predict_all<false>(a, bounds); }
void advance(const AdvanceArguments& a, PointBounds* bounds) { predict_all<true>(a, bounds); }

/// Zero for finite numbers, NaN for all others.
PLIANT_HD Wide zero_if_finite(const Record* four) {
  const Wide x = load_wide(floats(four));
  return x - x;  // NOLINT(misc-redundant-expression): see above
}

/// Tests all numbers at once: a sum with NaN is NaN. Four sums, because each addition waits for the one before.
bool all_finite(const Record* records, int first, int last) {
  Wide sums[4] = {Wide(0.f), Wide(0.f), Wide(0.f), Wide(0.f)};
  int i = first;
  for (; i + 16 <= last; i += 16) {
    PLIANT_UNROLL
    for (int k = 0; k < 4; ++k) sums[k] += zero_if_finite(records + i + 4 * k);
  }
  for (; i + 4 <= last; i += 4) sums[0] += zero_if_finite(records + i);
  float lanes[wide_width], rest = 0;
  store_wide(lanes, (sums[0] + sums[1]) + (sums[2] + sums[3]));
  for (float lane : lanes) rest = rest + lane;
  for (; i < last; ++i) {
    const Record& p = records[i];
    rest = rest + (p.x - p.x) + (p.y - p.y) + (p.z - p.z);
  }
  return rest == 0;
}

// ---------------------------------------------------------------- particles near a solid

/// How far each of sixteen particles is inside the margin of a solid [m]; negative: outside.
PLIANT_HD Wide nearness(const NearQuery& q, const WideRecords& x, const WideRecords& d) {
  const Vec3<Wide> place = x.position + d.position;
  const Vec3<Wide> away{place.x - Wide(q.pose.position.x), place.y - Wide(q.pose.position.y),
                        place.z - Wide(q.pose.position.z)};
  const Quat<Wide> back{Wide(-q.pose.rotation.x), Wide(-q.pose.rotation.y), Wide(-q.pose.rotation.z),
                        Wide(q.pose.rotation.w)};
  const Wide distance = signed_distance(q.shape, rotate(back, away)).distance;
  return Wide(q.margin) + sqrt(length_squared(d.position)) - distance;
}

int find_near(const NearQuery& q, std::int32_t* near) {
  int count = 0, i = q.first;
  for (; i + batch_width <= q.last; i += batch_width) {
    const std::int32_t runs[4] = {i, i + 4, i + 8, i + 12};
    float lanes[batch_width];
    store_wide(lanes, nearness(q, from_registers(load_runs(q.positions, runs)),
                               from_registers(load_runs(q.displacements, runs))));
    for (int k = 0; k < batch_width; ++k) {
      near[count] = i + k;
      count += lanes[4 * (k % 4) + k / 4] >= 0 ? 1 : 0;
    }
  }
  for (; i < q.last; ++i) near[count++] = i;  // the last ones, fewer than sixteen, all count as near
  return count;
}

}  // namespace
}  // namespace PLIANT_ISA

const StepKernels& PLIANT_OF_LEVEL(step_kernels)() {
  static constexpr StepKernels table{&all_finite, &update, &predict, &advance, &find_near};
  return table;
}

}  // namespace pliant
