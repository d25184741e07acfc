// Copies the motion of one World to another one whose particles have a different order.
//
// A State stores particles in the order of the compiled model, which depends on the sweep. To find that order, the
// World is given a State whose positions contain their own indices; the positions that it then reports are these
// indices.
#include <algorithm>

#include "apps/compare/compare.h"

namespace pliant::compare {

namespace {

/// Indices are written as two digits of this base, each of which is exact in a float.
constexpr std::size_t digit = std::size_t{1} << 20;

/// For each particle in the user's order, object by object, its index in the State.
std::vector<std::size_t> places_in(World& world) {
  const State kept = world.state();
  State numbered = kept;
  for (std::size_t i = 0; i < numbered.positions.size(); ++i) {
    const std::size_t low = i % digit, high = i / digit;
    numbered.positions[i].x = static_cast<float>(low);
    numbered.positions[i].y = static_cast<float>(high);
  }
  world.restore(numbered);
  std::vector<std::size_t> places;
  for (int object = 0; object < world.object_count(); ++object) {
    for (const Vec3f& p : world.object(object).positions())
      places.push_back(static_cast<std::size_t>(p.x) + digit * static_cast<std::size_t>(p.y));
  }
  world.restore(kept);
  return places;
}

void move(Record& to, const Record& from) { to = {from.x, from.y, from.z, to.w}; }

}  // namespace

void take_state(World& to, World& from, std::size_t collider_particles) {
  const std::vector<std::size_t> there = places_in(from), here = places_in(to);
  const State& given = from.state();
  State taken = to.state();  // targets of attachments are not copied, because the next substep sets them
  taken.time = given.time;
  taken.frame = given.frame;
  for (std::size_t i = 0; i < here.size(); ++i) {
    move(taken.positions[here[i]], given.positions[there[i]]);
    move(taken.remainders[here[i]], given.remainders[there[i]]);
    move(taken.velocities[here[i]], given.velocities[there[i]]);
  }
  // Particles of mesh colliders come last, in the same order in every World.
  const std::size_t total = taken.positions.size();
  for (std::size_t i = total - std::min(collider_particles, total); i < total; ++i) {
    move(taken.positions[i], given.positions[i]);
    move(taken.remainders[i], given.remainders[i]);
    move(taken.velocities[i], given.velocities[i]);
  }
  to.restore(taken);
}

}  // namespace pliant::compare
