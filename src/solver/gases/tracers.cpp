#include "solver/gases/tracers.h"

#include <algorithm>
#include <cmath>

#include "core/at.h"
#include "solver/forces.h"
#include "solver/gases/gas_formulas.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// SplitMix64 (Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// A number in [-1, 1), a multiple of 2^-23.
float symmetric(std::uint64_t bits) { return static_cast<float>(bits >> 40) / static_cast<float>(1 << 23) - 1; }

/// The velocity of the gases at a place: the mean of the particles around, weighted by the kernel. That of the air
/// where there is none.
Vec3f velocity_at(const std::vector<const GasPass*>& gases, const Vec3f& place, const Vec3f& air,
                  std::vector<SlotRange>& ranges) {
  Vec3f sum{};
  float weights = 0;
  for (const GasPass* met : gases) {
    const GasPass& gas = *met;
    const float reach = gas.pool->law.reach;
    const Vec3f around{reach, reach, reach};
    gas.pool->neighbours.order().find(place - around, place + around, ranges);
    for (const SlotRange& range : ranges)
      for (std::int32_t slot = range.first; slot < range.last; ++slot) {
        const GasPoint& of = gas.points[at(slot)];
        const float r2 = length_squared(place - of.place);
        if (!(r2 < reach * reach) || of.gas == nullptr) continue;
        const float q = 1 - sqrt(r2) / reach, weight = q * q * q;
        sum += of.velocity * weight;
        weights += weight;
      }
  }
  return weights > 0 ? sum * (1 / weights) : air;
}

/// The gases that an object meets by groups and masks. Those of a pool have the same.
std::vector<const GasPass*> met_by(const Substep& s, const CompiledObject& object, const std::vector<GasPass>& gases) {
  std::vector<const GasPass*> met;
  for (const GasPass& gas : gases) {
    const CompiledObject& other = s.model.objects[at(gas.pool->objects.front())];
    if ((object.mask & other.groups) != 0 && (other.mask & object.groups) != 0) met.push_back(&gas);
  }
  return met;
}

/// Puts the tracers that were emitted since the last pass at their places, with their ages.
void emit(Substep& s, const TracerPass& pass, std::vector<float>& ages) {
  const CompiledObject& object = s.model.objects[at(pass.object)];
  const Tracers& tracers = *object.tracers;
  const double now = time_of(s, s.number + 1);
  const std::int64_t until = emitted_until(tracers, now);
  const std::int64_t from = std::max(emitted_until(tracers, pass.since), until - object.user_particles);
  for (std::int64_t n = from; n < until; ++n) {
    const std::int64_t i = s.model.first[at(pass.object)] + object.place[at(n % object.user_particles)];
    const Vec3f place = place_in(tracers.source, static_cast<std::uint64_t>(n));
    Record& x = s.state.positions[at(i)];
    x = {place.x, place.y, place.z, x.w};
    s.state.remainders[at(i)] = {};
    const double born =
        static_cast<double>(tracers.start) + static_cast<double>(n + 1) / static_cast<double>(tracers.rate);
    ages[at(i)] = std::max(static_cast<float>(now - born), 0.f);
  }
}

}  // namespace

Vec3f place_in(const Region& region, std::uint64_t number) {
  const bool is_ball = region.radius > 0;
  Vec3f p{};
  for (std::uint64_t attempt = 0; attempt < 32; ++attempt) {
    const std::uint64_t x = mixed(32 * number + attempt), y = mixed(x), z = mixed(y);
    p = {symmetric(x), symmetric(y), symmetric(z)};
    if (!is_ball || length_squared(p) < 1) break;
  }
  if (is_ball) return region.centre + p * region.radius;
  return region.centre + Vec3f{p.x * region.half_size.x, p.y * region.half_size.y, p.z * region.half_size.z};
}

std::int64_t emitted_until(const Tracers& tracers, double time) {
  if (tracers.end > 0) time = std::min(time, static_cast<double>(tracers.end));
  const double seconds = time - static_cast<double>(tracers.start);
  return seconds > 0 ? static_cast<std::int64_t>(std::floor(seconds * static_cast<double>(tracers.rate))) : 0;
}

void advance_tracers(Substep& s, const std::vector<GasPass>& gases, const TracerPass& pass) {
  constexpr int in_a_task = 256;
  std::vector<float>& ages = channel_of(s.state, age_channel);
  const CompiledObject& object = s.model.objects[at(pass.object)];
  const Tracers& tracers = *object.tracers;
  const int first = s.model.first[at(pass.object)], last = first + object.particles;
  const Vec3f air = s.model.wind.air_density > 0 ? wind_at(s.model.wind, s.time_after) : Vec3f{};
  for (int i = first; i < last; ++i)
    if (ages[at(i)] >= 0 && (ages[at(i)] += pass.seconds) > tracers.lifetime) ages[at(i)] = no_age;
  emit(s, pass, ages);
  const std::vector<const GasPass*> met = met_by(s, object, gases);
  s.context.executor.parallel_for("respond: tracers", (object.particles + in_a_task - 1) / in_a_task, [&](int task) {
    std::vector<SlotRange> ranges;
    for (int i = first + task * in_a_task; i < std::min(first + (task + 1) * in_a_task, last); ++i) {
      Record& x = s.state.positions[at(i)];
      if (ages[at(i)] < 0) x = {tracers.source.centre.x, tracers.source.centre.y, tracers.source.centre.z, x.w};
      const Vec3f v = ages[at(i)] < 0 ? Vec3f{} : velocity_at(met, {x.x, x.y, x.z}, air, ranges);
      s.state.velocities[at(i)] = {v.x - pass.gravity.x, v.y - pass.gravity.y, v.z - pass.gravity.z, 0};
    }
  });
}

}  // namespace pliant
