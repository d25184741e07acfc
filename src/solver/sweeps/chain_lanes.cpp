// Chains and tethers in sixteen SIMD lanes, compiled per instruction set level under the rules of lanes.cpp.
//
// Each lane solves one path. Forward elimination loads each particle once, and stores in a contiguous scratch array
// what back substitution needs. Back substitution stores each particle once.
#include "math/wide.h"
#include "solver/sweeps/chain_kernels.h"
#include "solver/sweeps/chain_link.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

// Offsets of a link's data in the scratch array, in floats: direction, weight, change, coupling, and the displacements
// of its end particle.
constexpr int kept_direction = 0, kept_weight = 48, kept_change = 64, kept_coupling = 80, kept_displacements = 96;
static_assert(kept_displacements + 4 * wide_width == chain_scratch_floats);

PLIANT_HD void keep(float* to, const ChainLink<Wide>& link, const Registers& displacements) {
  store_wide(to + kept_direction, link.direction.x);
  store_wide(to + kept_direction + 16, link.direction.y);
  store_wide(to + kept_direction + 32, link.direction.z);
  store_wide(to + kept_weight, link.weight);
  store_wide(to + kept_change, link.change);
  store_wide(to + kept_coupling, link.coupling);
  std::memcpy(to + kept_displacements, &displacements, sizeof displacements);
}

/// Pointers to the pool rows of a chain's current batch, and the softness of its lanes.
struct ChainRows {
  const float *rest, *compliance;
  std::int32_t rest_step, compliance_step;
  Wide softness;

  PLIANT_HD ChainRows(const Pool& pool, int batch, const float* soft)
      : rest(pool.row(0, batch)),
        compliance(pool.row(1, batch)),
        rest_step(pool.row_step(0)),
        compliance_step(pool.row_step(1)),
        softness(load_wide(soft)) {}
  PLIANT_HD ChainParams<Wide> at(const float* multiplier) const {
    return {load_wide(rest), load_wide(compliance), softness,
            multiplier != nullptr ? load_wide(multiplier) : Wide(0.f)};
  }
  PLIANT_HD void next() {
    rest += rest_step;
    compliance += compliance_step;
  }
};

/// The displacements of sixteen particles in a substep, so far and at the velocities of its start, as coast_of.
struct WideMotion {
  Vec3<Wide> motion{}, coast{};

  WideMotion() = default;
  PLIANT_HD WideMotion(const SweepArguments& a, const std::int32_t* index, const Registers& displacements,
                       const Wide& w)
      : motion(from_registers(displacements - load_indexed(a.remainders, index)).position) {
    const Vec3<Wide> v = from_registers(load_indexed(a.velocities, index)).position;
    const auto falls = w > Wide(0.f);
    const Wide zero(0.f), h(a.h);
    coast = {(v.x + select(falls, Wide(a.gravity.x), zero)) * h, (v.y + select(falls, Wide(a.gravity.y), zero)) * h,
             (v.z + select(falls, Wide(a.gravity.z), zero)) * h};
  }
};

/// Forward elimination over all links. Returns the displacements of the first particles.
PLIANT_HD Registers eliminate_chain(const Pool& pool, const Segment* links, int steps, const float* softness,
                                    const float* multipliers, const SweepArguments& a, float* scratch,
                                    Wide& first_weight) {
  const std::int32_t* index = pool.indices.data() + links->index_offset;
  ChainRows rows(pool, links->first_batch, softness);
  Registers from = load_indexed(a.positions, index);
  const Registers start = load_indexed(a.displacements, index);
  Registers moved = start;
  ChainEnd<Wide> end{};
  first_weight = end.weight = from_registers(from).w;
  WideMotion before;
  if (a.keeps_energy) before = WideMotion(a, index, start, first_weight);
  for (int k = 0; k < steps; ++k, index += 2 * batch_width, rows.next(), scratch += chain_scratch_floats) {
    const Registers to = load_indexed(a.positions, index + batch_width);
    const Registers displacements = load_indexed(a.displacements, index + batch_width);
    const WideRecords across = from_registers((to - without_w(from)) + (displacements - moved));
    ChainParams<Wide> params = rows.at(multipliers != nullptr ? multipliers + k * batch_width : nullptr);
    if (a.keeps_energy) {
      const WideMotion of(a, index + batch_width, displacements, from_registers(to).w);
      params.motion = of.motion - before.motion;
      params.coast = of.coast - before.coast;
      before = of;
    }
    keep(scratch,
         k == 0 ? eliminate<true>(across.position, across.w, params, a, end)
                : eliminate<false>(across.position, across.w, params, a, end),
         displacements);
    from = to;
    moved = displacements;
  }
  return start;
}

PLIANT_HD void move_end(Record* displacements, const std::int32_t* index, const Registers& before,
                        const Vec3<Wide>& push, const Wide& weight, int lanes) {
  const Registers after = before + to_registers({push * weight, Wide(0.f)});
  if (lanes == batch_width) return store_indexed(displacements, index, after);
  store_indexed_some(displacements, index, after, lanes);
}

void solve_chain(const Pool& pool, const Segment* links, int steps, const float* softness, float* multipliers,
                 const SweepArguments& a, float* scratch) {
  if (multipliers != nullptr) multipliers += static_cast<std::int64_t>(links->first_batch) * batch_width;
  Wide first_weight;
  const Registers start =
      eliminate_chain(pool, links, steps, softness, a.first_pass ? nullptr : multipliers, a, scratch, first_weight);
  const Wide zero(0.f);
  Vec3<Wide> pull{zero, zero, zero};  // displacement that the correction of the next link causes
  Wide change = zero, coupling = zero;
  for (int k = steps - 1; k >= 0; --k) {
    const float* kept = scratch + static_cast<std::ptrdiff_t>(k) * chain_scratch_floats;
    change = load_wide(kept + kept_change) + coupling * change;
    coupling = load_wide(kept + kept_coupling);
    const Vec3<Wide> own = Vec3<Wide>{load_wide(kept + kept_direction), load_wide(kept + kept_direction + 16),
                                      load_wide(kept + kept_direction + 32)} *
                           change;
    Registers displacements;
    std::memcpy(&displacements, kept + kept_displacements, sizeof displacements);
    move_end(a.displacements, pool.indices.data() + links[k].index_offset + batch_width, displacements, own - pull,
             load_wide(kept + kept_weight), links[k].last_count);
    pull = own;
    if (multipliers != nullptr) {
      float* multiplier = multipliers + k * batch_width;
      store_wide(multiplier, a.first_pass ? change : load_wide(multiplier) + change);
    }
  }
  move_end(a.displacements, pool.indices.data() + links->index_offset, start, -pull, first_weight, links->last_count);
}

// ---------------------------------------------------------------- tethers

/// A register set with the same record in every lane.
PLIANT_HD Registers spread_record(const Record& record) {
  const Quad q = load_quad(&record);
#if PLIANT_PART_WIDTH == 16
  const Part part = __builtin_shufflevector(q, q, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
#elif PLIANT_PART_WIDTH == 8
  const Part part = __builtin_shufflevector(q, q, 0, 1, 2, 3, 0, 1, 2, 3);
#else
  const Part part = q;
#endif
  Registers r;
  PLIANT_EACH_PART({ r.at[0][i] = r.at[1][i] = r.at[2][i] = r.at[3][i] = part; })
  return r;
}

/// The positions and displacements of sixteen lanes' anchors.
struct WideAnchors {
  Registers positions, displacements;

  PLIANT_HD WideAnchors(const Tethers& tethers, const Tethers::Row& row, const Record* anchors) {
    if (row.anchor >= 0) {
      positions = spread_record(anchors[2 * row.anchor]);
      displacements = spread_record(anchors[2 * row.anchor + 1]);
      return;
    }
    std::int32_t index[batch_width];
    for (int lane = 0; lane < batch_width; ++lane) index[lane] = 2 * tethers.lane_anchors.data()[row.lanes + lane];
    positions = load_indexed(anchors, index);
    displacements = load_indexed(anchors + 1, index);
  }
};

PLIANT_HD void hold_batch(const Tethers& tethers, int batch, const Record* anchors, const SweepArguments& a) {
  const int first = batch * batch_width;
  const std::int32_t runs[4] = {first, first + 4, first + 8, first + 12};
  const Registers positions = without_w(load_runs(a.positions, runs));
  Registers displacements = load_runs(a.displacements, runs);
  Vec3<Wide> d = from_registers(displacements).position;
  bool moved = false;
  for (int slot = 0; slot < tethers.slots; ++slot) {
    const std::size_t row = static_cast<std::size_t>(batch) * tethers.slots + slot;
    const WideAnchors anchor(tethers, tethers.rows.data()[row], anchors);
    const Vec3<Wide> away =
        from_registers((positions - anchor.positions) + (displacements - anchor.displacements)).position;
    const Wide longest = load_wide(tethers.lengths.data() + row * batch_width);
    const Wide distance = sqrt(dot(away, away));
    const WideMask beyond = distance > longest;
    if (!any(beyond)) continue;
    const Vec3<Wide> back = d + away * tether_share(distance, longest);
    d = {select(beyond, back.x, d.x), select(beyond, back.y, d.y), select(beyond, back.z, d.z)};
    displacements = to_registers({d, Wide(0.f)});
    moved = true;
  }
  if (moved) store_runs(a.displacements, runs, displacements, 4);
}

/// Projects the first `count` particles of an object's last batch, one by one.
PLIANT_HD void hold_some(const Tethers& tethers, int batch, int count, const Record* anchors, const SweepArguments& a) {
  for (int lane = 0; lane < batch_width; ++lane) {
    const int place = 4 * (lane % 4) + lane / 4;
    if (place < count) hold_particle(tethers, batch, lane, batch * batch_width + place, anchors, a);
  }
}

void hold_tethers(const Tethers& tethers, const Record* anchors, int first, int last, const SweepArguments& a) {
  int i = first;
  for (; i + batch_width <= last; i += batch_width) hold_batch(tethers, i / batch_width, anchors, a);
  if (i < last) hold_some(tethers, i / batch_width, last - i, anchors, a);
}

}  // namespace
}  // namespace PLIANT_ISA

const ChainKernels& PLIANT_OF_LEVEL(chain_kernels)() {
  static constexpr ChainKernels table{&solve_chain, &hold_tethers};
  return table;
}

}  // namespace pliant
