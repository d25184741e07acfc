#include "solver/fluids/fluid_overlaps.h"

#include <algorithm>

#include "core/at.h"
#include "solver/bodies/body_math.h"
#include "solver/fluids/fluid_solver.h"
#include "solver/substep.h"

namespace pliant {

namespace {

constexpr float fastest_parting = 0.5f;  ///< [m/s]
constexpr float spacings_a_second = 20;  ///< of small spacings
constexpr float share_of_nudge = 0.5f;   ///< of the parting speed, for coincident particles
constexpr float most_nudge = 0.01f;      ///< of the spacing

/// The values of the channel; null if there is none.
template <class AnyState>
auto overlaps_in(AnyState& state) -> decltype(state.channels.front().values.data()) {
  for (auto& channel : state.channels)
    if (channel.name == overlap_channel) return channel.values.data();
  return nullptr;
}

/// A unit vector that differs between numbers.
Vec3f direction_of(std::uint32_t number) {
  const auto next = [&] {  // an integer hash (Wellons, "lowbias32")
    number += 0x9e3779b9U;
    std::uint32_t bits = number;
    bits = (bits ^ (bits >> 16)) * 0x21f0aaadU;
    bits = (bits ^ (bits >> 15)) * 0x735a2d97U;
    bits ^= bits >> 15;
    return static_cast<float>(bits >> 8) / static_cast<float>(1 << 23) - 1;
  };
  const float x = next(), y = next(), z = next();
  return unit_or(Vec3f{x, y, z}, Vec3f{0, 1, 0});
}

}  // namespace

float parting_speed(float spacing) { return std::min(fastest_parting, spacings_a_second * spacing); }

void FluidOverlaps::begin_frame(const State& state, const std::vector<std::int32_t>& points) {
  const float* const overlaps = overlaps_in(state);
  is_used_ = overlaps != nullptr &&
             std::any_of(points.begin(), points.end(), [&](std::int32_t point) { return overlaps[point] != 0; });
}

void FluidOverlaps::find(Substep& s, const FluidPool& pool) {
  limited_.clear();
  const float* const overlaps = overlaps_in(s.state);
  if (!is_used_ || overlaps == nullptr) return;
  const NeighbourLists& lists = pool.neighbours;
  overlaps_.assign(at(lists.nobody()) + NeighbourLists::lanes, 0);
  for (int slot = 0; slot < lists.slots(); ++slot) overlaps_[at(slot)] = overlaps[pool.of_slot[at(slot)]] != 0 ? 1 : 0;
  const float spacing = pool.law.reach / 2, coincident = coincident_share * spacing;
  const float nudge = std::min(most_nudge * spacing, share_of_nudge * parting_speed(spacing) * s.h);
  for (int slot = 0; slot < lists.slots(); ++slot) {
    const NeighbourGroup& group = lists.group(slot / NeighbourLists::lanes);
    bool is_limited = overlaps_[at(slot)] != 0, coincides = false;
    for (int k = 0; k < group.rows; ++k) {
      const std::int32_t other = group.slots[k * NeighbourLists::lanes + slot % NeighbourLists::lanes];
      is_limited = is_limited || overlaps_[at(other)] != 0;
      const Vec3f d = xyz(pool.places[at(slot)]) - xyz(pool.places[at(other)]);
      coincides = coincides || (overlaps_[at(slot)] != 0 && length_squared(d) < coincident * coincident);
    }
    if (is_limited) limited_.push_back({slot, 0});
    const std::int32_t point = pool.of_slot[at(slot)];
    if (!coincides || s.state.positions[at(point)].w == 0) continue;
    const int first = s.model.first[at(s.model.object_of(point))];
    Record& d = s.work.displacements[at(point)];
    d = plus(d, direction_of(static_cast<std::uint32_t>(point - first)) * nudge);
  }
}

void FluidOverlaps::begin_substep(const Substep& s, const FluidPool& pool) {
  const float parting = parting_speed(pool.law.reach / 2) * s.h;
  for (Limited& limited : limited_)
    limited.most = std::max(parting, length(xyz(s.work.displacements[at(pool.of_slot[at(limited.slot)])])));
}

void FluidOverlaps::limit(Substep& s, const FluidPool& pool, Records& weighted) const {
  for (const Limited& limited : limited_) {
    Record& d = s.work.displacements[at(pool.of_slot[at(limited.slot)])];
    const float moved = length(xyz(d));
    if (!(moved > limited.most)) continue;
    const float share = limited.most / moved;
    d = {d.x * share, d.y * share, d.z * share, d.w};
    weighted[at(limited.slot)].w *= share;
  }
}

void FluidOverlaps::end_substep(State& state, const FluidPool& pool) {
  if (limited_.empty()) return;
  float* const overlaps = overlaps_in(state);
  bool any = false;
  for (const Limited& limited : limited_) {
    float& overlap = overlaps[pool.of_slot[at(limited.slot)]];
    if (overlap != 0 && pool.densities[at(limited.slot)] <= parted_density) overlap = 0;
    any = any || overlap != 0;
  }
  if (any) return;
  is_used_ = false;
  limited_.clear();
}

}  // namespace pliant
