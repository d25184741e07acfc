#include "world/overlaps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "collision/neighbours/cell_order.h"
#include "core/at.h"
#include "math/record.h"
#include "parallel/launch.h"
#include "solver/fluids/fluid_law.h"
#include "solver/fluids/fluid_overlaps.h"

namespace pliant {

namespace {

/// Liquids mix if these are equal, as in FluidSolver.
auto kind_of_liquid(const CompiledObject& object) {
  return std::tuple{object.fluid->spacing, object.fluid->speed_of_sound, object.groups, object.mask};
}

/// The density at a place over that at rest, without walls; infinite where another point coincides.
float density_at(const CellOrder& order, const std::vector<Record>& points, std::size_t point, const FluidLaw& law,
                 std::vector<SlotRange>& ranges) {
  const Vec3f place = xyz(points[point]), margin{law.reach, law.reach, law.reach};
  const float coincident = coincident_share * law.reach / 2;
  float cubes = 0;
  order.find(place - margin, place + margin, ranges);
  for (const SlotRange& range : ranges)
    for (std::int32_t slot = range.first; slot < range.last; ++slot) {
      const auto other = at(order.points()[at(slot)]);
      if (other == point) continue;
      const float squared = length_squared(xyz(points[other]) - place);
      if (squared < coincident * coincident) return 1e30f;
      const float q = std::max(law.reach - std::sqrt(squared), 0.f);
      cubes += q * q * q;
    }
  return law.own + law.density_scale * cubes;
}

/// Which of the points overlap others.
std::vector<char> find_overlaps(Executor& executor, const std::vector<Record>& points, float spacing) {
  const FluidLaw law = fluid_law(spacing);
  std::vector<char> overlaps(points.size(), 0);
  CellOrder order;
  order.sort(executor, points, law.reach);
  const int count = static_cast<int>(points.size());
  executor.parallel_for("overlaps of liquids", launch_blocks(count), [&](int block) {
    std::vector<SlotRange> ranges;
    const int last = std::min((block + 1) * launch_block, count);
    for (int i = block * launch_block; i < last; ++i)
      overlaps[at(i)] = density_at(order, points, at(i), law, ranges) > overlapping_density ? 1 : 0;
  });
  return overlaps;
}

std::vector<Channel>::iterator overlap_channel_of(State& state) {
  return std::find_if(state.channels.begin(), state.channels.end(),
                      [](const Channel& one) { return one.name >= overlap_channel; });
}

bool is_overlap_channel(const State& state, std::vector<Channel>::const_iterator channel) {
  return channel != state.channels.end() && channel->name == overlap_channel;
}

/// Marks a particle. Channels are ordered by name.
void mark(State& state, std::int32_t particle) {
  auto channel = overlap_channel_of(state);
  if (!is_overlap_channel(state, channel))
    channel = state.channels.insert(channel, {overlap_channel, 1, std::vector<float>(state.positions.size(), 0.f)});
  channel->values[at(particle)] = 1;
}

/// The warning of an object's particles that overlap.
std::string words_of_overlaps(const CompiledObject& object, int overlapping) {
  const double speed = static_cast<double>(parting_speed(object.fluid->spacing));
  std::string words = std::to_string(speed);
  words.erase(words.find_last_not_of('0') + 1);
  return "object '" + object.name + "': " + std::to_string(overlapping) +
         (overlapping == 1 ? " particle is" : " particles are") +
         " placed so near others that the liquid is too dense there; they separate at up to " + words +
         " m/s: place particles a spacing apart, and let fills not overlap";
}

/// The objects that mix with one, itself among them.
std::vector<int> mixed_with(const WorldData& world, int number) {
  std::vector<int> mixed;
  const std::vector<CompiledObject>& all = world.model.objects;
  for (int o = 0; o < static_cast<int>(all.size()); ++o)
    if (all[at(o)].fluid && kind_of_liquid(all[at(o)]) == kind_of_liquid(all[at(number)])) mixed.push_back(o);
  return mixed;
}

/// Marks what overlaps among liquids that mix: particles of one object, or of all for -1.
void mark_overlaps_among(WorldData& world, const std::vector<int>& objects, int only) {
  std::vector<Record> points;
  std::vector<std::int32_t> particles;
  for (const int o : objects)
    for (int i = world.model.first[at(o)]; i < world.model.end_of(o); ++i) {
      if (!is_there(world.state, at(i))) continue;
      points.push_back(world.state.positions[at(i)]);
      particles.push_back(i);
    }
  if (points.empty()) return;
  const float spacing = world.model.objects[at(objects.front())].fluid->spacing;
  std::vector<char> overlaps;
  world.executor.enter([&] { overlaps = find_overlaps(world.executor, points, spacing); });
  std::vector<int> counts(world.model.objects.size(), 0);
  for (std::size_t i = 0; i < overlaps.size(); ++i) {
    const int o = overlaps[i] != 0 ? world.model.object_of(particles[i]) : -1;
    if (o < 0 || (only >= 0 && o != only)) continue;
    mark(world.state, particles[i]);
    ++counts[at(o)];
  }
  for (const int o : objects)
    if (counts[at(o)] > 0) world.warnings.push_back(words_of_overlaps(world.model.objects[at(o)], counts[at(o)]));
}

}  // namespace

void mark_overlaps(WorldData& world, int number) {
  const std::vector<CompiledObject>& all = world.model.objects;
  if (number >= 0) {
    if (all[at(number)].fluid) mark_overlaps_among(world, mixed_with(world, number), number);
    return;
  }
  for (int o = 0; o < static_cast<int>(all.size()); ++o) {
    if (!all[at(o)].fluid) continue;
    const std::vector<int> mixed = mixed_with(world, o);
    if (mixed.front() == o) mark_overlaps_among(world, mixed, -1);
  }
}

void forget_overlaps(WorldData& world) {
  const auto channel = overlap_channel_of(world.state);
  if (!is_overlap_channel(world.state, channel)) return;
  const bool any = std::any_of(channel->values.begin(), channel->values.end(), [](float value) { return value != 0; });
  if (!any) world.state.channels.erase(channel);
}

}  // namespace pliant
