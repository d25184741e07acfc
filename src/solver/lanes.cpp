// Sixteen constraints at a time. This unit is compiled once for each instruction set level (cmake/PliantLanes.cmake); the
// macro PLIANT_LEVEL gives each table its own name. It uses only always-inlined functions and the inline namespace of
// its level, so that the linker never mixes code of two levels.
#include "constraints/in_lanes.h"
#include "math/wide.h"
#include "solver/kernels.h"
#include "solver/project.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

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
  // One call for both: a second copy of the projection for the last batch doubles the code for nothing.
  const bool ends_whole = segment.last_count == (segment.runs != 0 ? 4 : batch_width);
  for (int left = segment.batches; left > 0; --left) {
    project_batch<T, law, keeps_multipliers, fixed, general>(rows, slots, index, multiplier, left > 1 || ends_whole,
                                                             segment.last_count, aside, a);
    index += slots.before(slot_count<T>);
    aside.next(slot_count<T>);
    rows.next();
    if constexpr (keeps_multipliers) multiplier += batch_width;
  }
}

/// Which slots are contiguous is a template argument where loads and stores take much of the time.
template <class T, Law law, bool keeps_multipliers, bool general>
void sweep_either(const Pool& pool, const Segment& segment, float* multipliers, const SweepArguments& a) {
  const auto with = [&]<std::int32_t fixed>(std::integral_constant<std::int32_t, fixed>) {
    sweep_segment<T, law, keeps_multipliers, fixed, general>(pool, segment, multipliers, a);
  };
  constexpr bool is_large = 4 < slot_count<T>;
  if constexpr (general || is_large || is_arithmetic<T>) return with(std::integral_constant<std::int32_t, any_set>{});
  constexpr std::int32_t all = (1 << slot_count<T>)-1;
  if (segment.runs == all) return with(std::integral_constant<std::int32_t, all>{});
  if (segment.runs == 0) return with(std::integral_constant<std::int32_t, 0>{});
  if constexpr (slot_count<T> == 2) {
    return segment.runs == 1 ? with(std::integral_constant<std::int32_t, 1>{})
                             : with(std::integral_constant<std::int32_t, 2>{});
  }
  if constexpr (slot_count<T> != 2) with(std::integral_constant<std::int32_t, any_set>{});
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

}  // namespace
}  // namespace PLIANT_ISA

const SweepKernels& PLIANT_OF_LEVEL(sweep_kernels)() {
  static constexpr SweepKernels table{&sweep<false>, &sweep<true>};
  return table;
}

}  // namespace pliant
