// The sweeps in sixteen lanes. This unit is compiled once for each instruction set level (cmake/PliantLanes.cmake); the
// macro PLIANT_LEVEL gives each table its own name. It uses only always-inlined functions and the inline namespace of
// its level, so that the linker never mixes code of two levels.
#include "constraints/in_lanes.h"
#include "math/wide.h"
#include "solver/kernels.h"
#include "solver/project.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

// ---------------------------------------------------------------- constraints

/// A value of the template parameter `fixed`: which slots are contiguous is known only at run time, for each segment.
constexpr std::int32_t any_set = -1;

/// Which slots of a batch are contiguous, and where the indices of each slot begin.
template <int size, std::int32_t fixed>
struct SlotIndices {
  std::int32_t runs;

  PLIANT_HD explicit SlotIndices(std::int32_t in_runs) : runs(fixed == any_set ? in_runs : fixed) {}
  PLIANT_HD bool in_runs(int slot) const { return ((fixed == any_set ? runs : fixed) >> slot & 1) != 0; }
  /// The number of indices that precede those of `slot`.
  PLIANT_HD std::int32_t before(int slot) const { return indices_before(fixed == any_set ? runs : fixed, slot); }

  PLIANT_HD Registers load(const Record* base, const std::int32_t* index, int slot) const {
    return in_runs(slot) ? load_runs(base, index + before(slot)) : load_indexed(base, index + before(slot));
  }
  PLIANT_HD void store(Record* base, const std::int32_t* index, int slot, const Registers& records, bool whole,
                       int count) const {
    if (in_runs(slot)) return store_runs(base, index + before(slot), records, whole ? 4 : count);
    if (whole) return store_indexed(base, index + before(slot), records);
    store_indexed_some(base, index + before(slot), records, count);
  }
};

/// Positions relative to the stencil's first particle: x_i = ((position_i - position_0) + displacement_i) -
/// displacement_0, so x_0 is zero. Differences between neighbours are small and nearly exact, and constraints are
/// translation-invariant. The subtraction precedes the transpose, so that for the first particle only w is transposed.
template <int size, std::int32_t fixed>
PLIANT_HD void load_stencil(const SweepArguments& a, const SlotIndices<size, fixed>& slots, const std::int32_t* index,
                            Registers (&moved)[size], Vec3<Wide> (&x)[size], Wide (&w)[size]) {
  const Registers origin = slots.load(a.positions, index, 0);
  moved[0] = slots.load(a.displacements, index, 0);
  x[0] = {Wide(0.f), Wide(0.f), Wide(0.f)};
  w[0] = w_of(origin);
  PLIANT_UNROLL
  for (int slot = 1; slot < size; ++slot) {
    const Registers apart = minus_xyz(slots.load(a.positions, index, slot), origin);
    moved[slot] = slots.load(a.displacements, index, slot);
    const WideRecords records = from_registers((apart + moved[slot]) - moved[0]);
    x[slot] = records.position;
    w[slot] = records.w;
  }
}

/// Pointers to a pool's rows for one batch. A row that is constant over the pool keeps its address.
template <int rows>
struct RowPointers {
  const float* at[rows];
  std::int32_t step[rows];

  PLIANT_HD RowPointers(const Pool& pool, int batch) {
    PLIANT_UNROLL
    for (int row = 0; row < rows; ++row) {
      at[row] = pool.row(row, batch);
      step[row] = pool.row_step(row);
    }
  }
  PLIANT_HD void next() {
    PLIANT_UNROLL
    for (int row = 0; row < rows; ++row) at[row] += step[row];
  }
};

/// The additional arrays of a general sweep for one batch.
struct Aside {
  Record* corrections = nullptr;  ///< receives corrections instead of applying them, sixteen for each slot
  const float* share = nullptr;   ///< share of a change that reaches the multiplier, one per lane

  PLIANT_HD Aside(const SweepArguments& a, const Segment& segment, int size) {
    const std::int64_t first = static_cast<std::int64_t>(segment.first_batch) * batch_width;
    if (a.corrections != nullptr) corrections = a.corrections[segment.pool] + first * size;
    if (a.shares != nullptr) share = a.shares[segment.pool] + first;
  }
  PLIANT_HD void next(int size) {
    if (corrections != nullptr) corrections += static_cast<std::ptrdiff_t>(size) * batch_width;
    if (share != nullptr) share += batch_width;
  }
};
/// Replaces Aside in sweeps that store no corrections.
struct NothingAside {
  PLIANT_HD NothingAside(const SweepArguments&, const Segment&, int) {}
  PLIANT_HD void next(int) {}
};
template <bool general>
using AsideOf = std::conditional_t<general, Aside, NothingAside>;

PLIANT_HD void store_aside(Record* to, const Vec3<Wide>& correction) {
  constexpr std::int32_t places[4] = {0, 4, 8, 12};
  store_runs(to, places, to_registers({correction, Wide(0.f)}), 4);
}

/// Projects one batch: `rows` are its parameters, `index` its particles. Stores all lanes if `whole`; otherwise the
/// first `count` groups of four lanes, or the first `count` lanes if no slot is contiguous.
template <class T, Law law, bool keeps_multipliers, std::int32_t fixed, bool general, int row_count>
PLIANT_HD void project_batch(const RowPointers<row_count>& rows, const SlotIndices<slot_count<T>, fixed>& slots,
                             const std::int32_t* index, float* multiplier, bool whole, int count,
                             const AsideOf<general>& aside, const SweepArguments& a) {
  constexpr int fields = static_cast<int>(sizeof(typename T::template Params<float>) / sizeof(float));
  Vec3<Wide> x[slot_count<T>];
  Wide w[slot_count<T>];
  Registers moved[slot_count<T>];  // displacements, kept in registers, because loading sixteen records again costs more
  load_stencil(a, slots, index, moved, x, w);
  Wide rest[fields];
  PLIANT_UNROLL
  for (int field = 0; field < fields; ++field) rest[field] = load_wide(rows.at[field]);
  typename T::template Params<Wide> params;
  std::memcpy(&params, rest, sizeof params);
  ConstraintResponse<Wide> response{load_wide(rows.at[fields]), Wide(0.f), Wide(0.f)};
  if constexpr (keeps_multipliers) {
    if (!a.first_pass) response.multiplier = load_wide(multiplier);
  }
  Vec3<Wide> motion[slot_count<T>];
  if constexpr (law == Law::damped) {
    response.damping = load_wide(rows.at[fields + 1]);
    PLIANT_UNROLL
    for (int slot = 0; slot < slot_count<T>; ++slot)
      motion[slot] = from_registers(moved[slot] - slots.load(a.remainders, index, slot)).position;
  }
  Vec3<Wide> correction[slot_count<T>];
  if constexpr (general) {
    if (aside.share != nullptr) response.share = load_wide(aside.share);
  }
  project<T, law, keeps_multipliers, general>(x, w, params, motion, response, a, correction);
  if constexpr (keeps_multipliers) store_wide(multiplier, response.multiplier);
  if constexpr (general) {
    if (aside.corrections != nullptr) {
      PLIANT_UNROLL
      for (int slot = 0; slot < slot_count<T>; ++slot)
        store_aside(aside.corrections + slot * batch_width, correction[slot]);
      return;
    }
  } else {
    (void)aside;
  }
  PLIANT_UNROLL
  for (int slot = 0; slot < slot_count<T>; ++slot) {
    const Registers after = moved[slot] + to_registers({correction[slot], Wide(0.f)});
    slots.store(a.displacements, index, slot, after, whole, count);
  }
}

template <class T, Law law, bool keeps_multipliers, std::int32_t fixed, bool general>
void sweep_segment(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& arguments) {
  const SweepArguments a = arguments;  // a local copy, which no store can alias, so that it stays in registers
  constexpr int fields = static_cast<int>(sizeof(typename T::template Params<float>) / sizeof(float));
  RowPointers<fields + 1 + (law == Law::damped ? 1 : 0)> rows(pool, segment.first_batch);
  const SlotIndices<slot_count<T>, fixed> slots(segment.runs);
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  float* multiplier =
      keeps_multipliers ? multipliers + static_cast<std::int64_t>(segment.first_batch) * batch_width : nullptr;
  AsideOf<general> aside(a, segment, slot_count<T>);
  const bool whole = segment.last_count == (segment.runs != 0 ? 4 : batch_width);
  for (int left = segment.batches; left > (whole ? 0 : 1); --left) {
    project_batch<T, law, keeps_multipliers, fixed, general>(rows, slots, index, multiplier, true, 0, aside, a);
    index += slots.before(slot_count<T>);
    aside.next(slot_count<T>);
    rows.next();
    if constexpr (keeps_multipliers) multiplier += batch_width;
  }
  if (whole) return;
  project_batch<T, law, keeps_multipliers, fixed, general>(rows, slots, index, multiplier, false, segment.last_count, aside,
                                                           a);
}

template <class T, Law law, bool keeps_multipliers, bool general>
void sweep_either(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  constexpr std::int32_t all = (1 << slot_count<T>)-1;
  const auto with = [&]<std::int32_t fixed>(std::integral_constant<std::int32_t, fixed>) {
    sweep_segment<T, law, keeps_multipliers, fixed, general>(pool, segment, multipliers, a);
  };
  if (segment.runs == all) return with(std::integral_constant<std::int32_t, all>{});
  if constexpr (!general) {
    if (segment.runs == 0) return with(std::integral_constant<std::int32_t, 0>{});
    if constexpr (slot_count<T> == 2) {
      return segment.runs == 1 ? with(std::integral_constant<std::int32_t, 1>{})
                               : with(std::integral_constant<std::int32_t, 2>{});
    }
  }
  if constexpr (general || slot_count<T> != 2) with(std::integral_constant<std::int32_t, any_set>{});
}

template <class T, bool general>
void sweep_type(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  const bool keeps = multipliers != nullptr;
  switch (pool.law) {
    case Law::compliant:
      return keeps ? sweep_either<T, Law::compliant, true, general>(pool, segment, multipliers, a)
                   : sweep_either<T, Law::compliant, false, general>(pool, segment, multipliers, a);
    case Law::damped:
      return keeps ? sweep_either<T, Law::damped, true, general>(pool, segment, multipliers, a)
                   : sweep_either<T, Law::damped, false, general>(pool, segment, multipliers, a);
    case Law::pbd:
      return sweep_either<T, Law::pbd, false, general>(pool, segment, multipliers, a);
  }
}

template <bool general, class... Types>
void sweep_any(TypeList<Types...>, const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  using Function = void (*)(const Pool&, const Segment&, float*, const SweepArguments&);
  static_assert((in_lanes<Types> && ...), "other types are projected one at a time");
  static constexpr Function table[] = {&sweep_type<Types, general>...};
  table[pool.type](pool, segment, multipliers, a);
}

template <bool general>
void sweep(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& a) {
  for (const Segment* segment = first; segment != last; ++segment) {
    float* multipliers = a.multipliers != nullptr ? a.multipliers[segment->pool] : nullptr;
    sweep_any<general>(LaneConstraints{}, pools[segment->pool], *segment, multipliers, a);
  }
}

// ---------------------------------------------------------------- particles, four records at a time

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
  return {load_wide(floats(a.positions + i)), load_wide(floats(a.displacements + i)), load_wide(floats(a.remainders + i)),
          load_wide(floats(a.velocities + i))};
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

/// Predicts all particles, after their update if `updates`, and finds the bounds of their motion unless `bounds` is null.
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
    store_wide(lanes,
               nearness(q, from_registers(load_runs(q.positions, runs)), from_registers(load_runs(q.displacements, runs))));
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
  static constexpr StepKernels table{&sweep<false>, &sweep<true>, &all_finite, &update, &predict, &advance, &find_near};
  return table;
}

}  // namespace pliant
