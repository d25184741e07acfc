// The motion of one World put into another that numbers its particles otherwise.
//
// A State lists particles in the order of the compiled model, which a sweep may choose; only a World knows which of them is
// which of the user's. So a World is asked: it is given a state whose positions are the numbers of their places, and what it then
// says of the user's particles are those numbers.
#include <algorithm>

#include "apps/compare/compare.h"

namespace pliant::compare {

namespace {

/// Two digits of a place's number, each a float without rounding.
constexpr std::size_t digit = std::size_t{1} << 20;

/// Of every particle of the user's, object after object: where it is in a State.
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
    for (const Vec3f& p : world.positions(object))
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
  State taken = to.state();  // targets of attachments are nobody's particles: they go where they belong in the next substep
  taken.time = given.time;
  taken.frame = given.frame;
  for (std::size_t i = 0; i < here.size(); ++i) {
    move(taken.positions[here[i]], given.positions[there[i]]);
    move(taken.remainders[here[i]], given.remainders[there[i]]);
    move(taken.velocities[here[i]], given.velocities[there[i]]);
  }
  // Mesh colliders come last and are numbered alike in every World.
  const std::size_t total = taken.positions.size();
  for (std::size_t i = total - std::min(collider_particles, total); i < total; ++i) {
    move(taken.positions[i], given.positions[i]);
    move(taken.remainders[i], given.remainders[i]);
    move(taken.velocities[i], given.velocities[i]);
  }
  to.restore(taken);
}

}  // namespace pliant::compare
