#include "solver/fluids/fluid_log.h"

#include <algorithm>

#include "solver/bodies/body_solver.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// A wall as a side of the contact log.
ContactSide side_of(const Substep& s, const FluidBounds& bounds, std::int32_t wall) {
  const int colliders = bounds.number_of_colliders(), primitives = static_cast<int>(s.model.colliders.size());
  if (wall < primitives) return {body_of_collider(wall), -1};
  if (wall < colliders) return {s.model.fields[static_cast<std::size_t>(wall - primitives)].object, -1};
  const int body = s.bodies->solids().body_of_solid()[static_cast<std::size_t>(wall - colliders)];
  const TouchedBody& touched = s.bodies->touched_bodies()[static_cast<std::size_t>(body)];
  return {touched.object, touched.body};
}

void log_slot(const Substep& s, const FluidPool& pool, const FluidBounds& bounds, int slot, ContactLog& log) {
  const Record& place = pool.weighted[static_cast<std::size_t>(slot)];
  const bool is_fixed = !pool.lightness.empty() && pool.lightness[static_cast<std::size_t>(slot)] == 0;
  if (place.w == 0 || is_fixed) return;
  const int liquid = s.model.object_of(pool.of_slot[static_cast<std::size_t>(slot)]);
  const Vec3f at{place.x, place.y, place.z};
  for (const WallGradient& wall : pool.walls.gradients(pool.law, bounds, at, slot / NeighbourLists::lanes)) {
    const double size = static_cast<double>(pool.mass) * static_cast<double>(place.w) / static_cast<double>(s.h);
    add_pressure({liquid, -1}, side_of(s, bounds, wall.which), convert<double>(wall.gradient) * size,
                 convert<double>(at), log);
  }
}

}  // namespace

void log_pressure(const Substep& s, const FluidPool& pool, const FluidBounds& bounds, ContactLog& log) {
  for (int group = 0; group < pool.neighbours.groups(); ++group) {
    if (pool.walls.has_any()[static_cast<std::size_t>(group)] == 0) continue;
    const int first = group * NeighbourLists::lanes;
    const int last = std::min(first + NeighbourLists::lanes, pool.neighbours.slots());
    for (int slot = first; slot < last; ++slot) log_slot(s, pool, bounds, slot, log);
  }
}

}  // namespace pliant
