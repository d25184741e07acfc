// Chains and tethers in scalar floats, one path or particle at a time: the readable reference of chain_lanes.cpp.
#include <cstring>

#include "solver/sweeps/chain_kernels.h"
#include "solver/sweeps/chain_link.h"

namespace pliant {

namespace {

/// One lane of a chain. As in the SIMD lanes, steps beyond the path's end are links of length zero, which have no
/// effect.
class Lane {
 public:
  Lane(const Pool& pool, const Segment* links, int lane, const SweepArguments& a, float* multipliers)
      : pool_(pool), links_(links), lane_(lane), a_(a), multipliers_(multipliers) {}

  void eliminate_all(int steps, float softness, float* scratch) const {
    ChainEnd<float> end{};
    end.weight = a_.positions[particle(0, 0)].w;
    for (int k = 0; k < steps; ++k) {
      const int from = particle(k, 0), to = particle(k, 1);
      const Record &p = a_.positions[from], &q = a_.positions[to];
      const Record &d = a_.displacements[from], &e = a_.displacements[to];
      const Vec3f across{(q.x - p.x) + (e.x - d.x), (q.y - p.y) + (e.y - d.y), (q.z - p.z) + (e.z - d.z)};
      const std::int64_t batch = links_[k].first_batch;
      ChainParams<float> params{pool_.row(0, batch)[lane_], pool_.row(1, batch)[lane_], softness,
                                multipliers_ != nullptr && !a_.first_pass ? *multiplier(k) : 0.f};
      if (a_.keeps_energy) {
        params.motion = motion_of(to) - motion_of(from);
        params.coast = coast_of(a_, to) - coast_of(a_, from);
      }
      const ChainLink<float> link =
          k == 0 ? eliminate<true>(across, q.w, params, a_, end) : eliminate<false>(across, q.w, params, a_, end);
      std::memcpy(scratch + k * floats_per_link, &link, sizeof link);
    }
  }

  void substitute(int steps, const float* scratch) const {
    const float first_weight = a_.positions[particle(0, 0)].w;
    Vec3f pull{};
    float change = 0, coupling = 0;
    for (int k = steps - 1; k >= 0; --k) {
      ChainLink<float> link;
      std::memcpy(static_cast<void*>(&link), scratch + k * floats_per_link, sizeof link);
      change = link.change + coupling * change;
      coupling = link.coupling;
      const Vec3f own = link.direction * change;
      move(k, 1, (own - pull) * link.weight);
      pull = own;
      if (multipliers_ != nullptr) *multiplier(k) = a_.first_pass ? change : *multiplier(k) + change;
    }
    move(0, 0, -pull * first_weight);
  }

 private:
  static constexpr int floats_per_link = sizeof(ChainLink<float>) / sizeof(float);

  int particle(int k, int slot) const {
    return pool_.indices[static_cast<std::size_t>(links_[k].index_offset) + slot * batch_width + lane_];
  }
  Vec3f motion_of(int particle) const {
    const Record &d = a_.displacements[particle], &r = a_.remainders[particle];
    return {d.x - r.x, d.y - r.y, d.z - r.z};
  }
  float* multiplier(int k) const {
    return multipliers_ + static_cast<std::int64_t>(links_[k].first_batch) * batch_width + lane_;
  }
  void move(int k, int slot, const Vec3f& by) const {
    if (lane_ >= links_[k].last_count) return;
    Record& d = a_.displacements[particle(k, slot)];
    d = {d.x + by.x, d.y + by.y, d.z + by.z, 0};
  }

  const Pool& pool_;
  const Segment* links_;
  int lane_;
  const SweepArguments& a_;
  float* multipliers_;
};

void solve_chain(const Pool& pool, const Segment* links, int steps, const float* softness, float* multipliers,
                 const SweepArguments& a, float* scratch) {
  for (int i = 0; i < links->last_count; ++i) {
    const Lane lane(pool, links, i, a, multipliers);
    lane.eliminate_all(steps, softness[i], scratch);
    lane.substitute(steps, scratch);
  }
}

void hold_tethered(const Tethers& tethers, const Record* anchors, int first, int last, const SweepArguments& a) {
  for (int i = first; i < last; ++i) {
    const int place = i % batch_width;
    hold_particle(tethers, i / batch_width, 4 * (place % 4) + place / 4, i, anchors, a);
  }
}

}  // namespace

const ChainKernels& chain_kernels_sequential() {
  static constexpr ChainKernels table{&solve_chain, &hold_tethered};
  return table;
}

}  // namespace pliant
