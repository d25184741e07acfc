// The search for long distances in sixteen SIMD lanes, compiled per instruction set level under the rules of lanes.cpp.
#include <array>
#include <type_traits>

#include "math/lane_bits.h"
#include "math/wide.h"
#include "solver/length_kernels.h"
#include "solver/length_of.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

/// Which slots of the segment are contiguous, as a compile-time constant.
template <std::int32_t runs>
struct Ends {
  const std::int32_t* index;

  template <int slot>
  PLIANT_HD Registers load(const Record* base) const {
    const std::int32_t* at = index + indices_before(runs, slot);
    if constexpr ((runs >> slot & 1) != 0)
      return load_runs(base, at);
    else
      return load_indexed(base, at);
  }
  /// The difference between the records of both ends.
  PLIANT_HD Registers between(const Record* base) const { return load<1>(base) - load<0>(base); }
  PLIANT_HD Vec3<Wide> across(const Record* base) const { return from_registers(between(base)).position; }
  /// The lanes of which an end has finite mass.
  PLIANT_HD std::uint32_t free(const Record* base) const {
    return lane_bits(w_of(load<0>(base)) + w_of(load<1>(base)) > Wide(0.f));
  }
};

/// A batch of a pool's distances.
template <std::int32_t runs>
struct Batch {
  const Pool& pool;
  const Segment& segment;
  int s, b;  ///< the numbers of the segment, and of the batch in it
  Ends<runs> ends;

  PLIANT_HD std::int64_t number() const { return std::int64_t{segment.first_batch} + b; }
  PLIANT_HD Wide row(int at) const { return load_wide(pool.row(at, number())); }
  /// The lanes that are no padding: as lane_is_valid.
  PLIANT_HD std::uint32_t valid() const {
    const std::uint32_t some = (1u << segment.last_count) - 1;
    return b + 1 < segment.batches ? 0xffff : runs != 0 ? some * 0x1111 : some;
  }
};

/// The length that forces explain, by lane.
template <std::int32_t runs>
PLIANT_HD Wide explained(const Batch<runs>& of, const float* multipliers, const Vec3<Wide>& across,
                         const LengthQuery& q) {
  const Wide compliance = of.row(1);
  const Wide elastic =
      explained_by_force(compliance, load_wide(multipliers + of.number() * batch_width), Wide(q.inverse_h2));
  if (of.pool.law != Law::damped || q.velocities == nullptr) return elastic;
  return elastic + explained_by_damping(across, of.ends.across(q.velocities), compliance, of.row(2), q.inverse_h2);
}

/// Hands constraints over many at a time, because each call costs as much as measuring a batch.
struct Reports {
  static constexpr int most = 64;
  FoundLengthCallback found;
  void* context;
  int count = 0;
  std::array<FoundLength, most> all;

  PLIANT_HD Reports(FoundLengthCallback in_found, void* in_context) : found(in_found), context(in_context) {}
  PLIANT_HD void add(const FoundLength& one) {
    if (count == most) hand_over();
    all.data()[count++] = one;
  }
  PLIANT_HD void hand_over() {
    if (count > 0) found(context, all.data(), count);
    count = 0;
  }
};

/// Reports the constraints of a batch whose values exceed `above`.
template <std::int32_t runs>
PLIANT_HD void report(const Batch<runs>& of, const Wide& values, float above, const Record* positions,
                      Reports& reports) {
  std::uint32_t bits = lane_bits(values > Wide(above)) & of.valid();
  if (bits == 0) return;
  bits &= lane_bits(of.row(0) > Wide(0.f)) & of.ends.free(positions);
  float lanes[batch_width];
  store_wide(lanes, values);
  for (; bits != 0; bits &= bits - 1) {
    const int lane = __builtin_ctz(bits);
    reports.add({of.s, of.b, lane, lanes[lane]});
  }
}

/// Calls body(batch) for the batches of segments [first, last).
template <class Body>
PLIANT_HD void for_batches(const Pool& pool, const Segment* segments, int first, int last, const Body& body) {
  for (int s = first; s < last; ++s) {
    const Segment& segment = segments[s];
    const auto visit = [&]<std::int32_t runs>(std::integral_constant<std::int32_t, runs>) {
      const std::int32_t* index = pool.indices.data() + segment.index_offset;
      for (int b = 0; b < segment.batches; ++b, index += indices_before(runs, 2))
        body(Batch<runs>{pool, segment, s, b, {index}});
    };
    switch (segment.runs) {
      case 0:
        visit(std::integral_constant<std::int32_t, 0>{});
        break;
      case 1:
        visit(std::integral_constant<std::int32_t, 1>{});
        break;
      case 2:
        visit(std::integral_constant<std::int32_t, 2>{});
        break;
      default:
        visit(std::integral_constant<std::int32_t, 3>{});
    }
  }
}

/// Most batches have no long constraint; comparing squares finds these without a square root and a division.
template <bool moves, bool is_forced>
PLIANT_HD void find_among(const Pool& pool, const Segment* segments, int first, int last, const LengthQuery& query,
                          FoundLengthCallback found, void* context) {
  const LengthQuery q = query;  // a local copy, which no callback changes
  Reports reports(found, context);
  const float* multipliers = is_forced ? q.multipliers[segments[first].pool] : nullptr;
  const Wide above(q.above);
  for_batches(
      pool, segments, first, last, [&](const auto& batch) __attribute__((always_inline)) {
        Registers apart = batch.ends.between(q.positions);
        if constexpr (moves) apart = apart + batch.ends.between(q.displacements);
        const Vec3<Wide> across = from_registers(apart).position;
        const Wide rest = batch.row(0);
        Wide by_force(0.f);
        if constexpr (is_forced) by_force = explained(batch, multipliers, across, q);
        if (lane_bits(length_squared(across) >= least_squared(rest, above, by_force)) == 0) return;
        if constexpr (is_forced)
          report(batch, overstretch(across, rest, by_force), q.above, q.positions, reports);
        else
          report(batch, overstretch(across, rest), q.above, q.positions, reports);
      });
  reports.hand_over();
}

/// True if the compliance is zero throughout: then force explains no length, and the multipliers need not be read.
PLIANT_HD bool is_rigid(const Pool& pool) { return pool.row_step(1) == 0 && pool.row(1, 0)[0] == 0; }

void find_long(const Pool& pool, const Segment* segments, int first, int last, const LengthQuery& q,
               FoundLengthCallback found, void* context) {
  const bool moves = q.displacements != nullptr;
  if (q.multipliers != nullptr && q.multipliers[segments[first].pool] != nullptr && !is_rigid(pool))
    return moves ? find_among<true, true>(pool, segments, first, last, q, found, context)
                 : find_among<false, true>(pool, segments, first, last, q, found, context);
  moves ? find_among<true, false>(pool, segments, first, last, q, found, context)
        : find_among<false, false>(pool, segments, first, last, q, found, context);
}

void find_demanding(const Pool& pool, const Segment* segments, int first, int last, const DemandQuery& query,
                    FoundLengthCallback found, void* context) {
  const DemandQuery q = query;  // a local copy, which no callback changes
  Reports reports(found, context);
  const Wide by_stretch(q.by_stretch), by_turn(q.by_turn);
  for_batches(
      pool, segments, first, last, [&](const auto& batch) __attribute__((always_inline)) {
        const Vec3<Wide> across = batch.ends.across(q.positions), speed = batch.ends.across(q.velocities);
        report(batch, demand(across, speed, batch.row(0), by_stretch, by_turn), q.above, q.positions, reports);
      });
  reports.hand_over();
}

}  // namespace
}  // namespace PLIANT_ISA

const LengthKernels& PLIANT_OF_LEVEL(length_kernels)() {
  static constexpr LengthKernels table{&find_long, &find_demanding};
  return table;
}

}  // namespace pliant
