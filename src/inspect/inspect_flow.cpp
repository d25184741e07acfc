// Warnings about liquids, gases and grains: particles that start within one another, and emitters that shoot.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "collision/neighbours/cell_order.h"
#include "inspect/problems.h"

namespace pliant {

namespace {

/// Particles nearer than this share of the smaller distance at which they rest push each other away in the first frame.
constexpr float crowded_share = 0.5f;
/// A jet that is faster than this from an opening has probably a flow in litres a second [m/s].
constexpr float fast_jet = 30;

/// The distance at which particles of an object rest [m]; 0: it is neither liquid nor gas nor grains.
float distance_at_rest(const Object& object) {
  if (object.grains) return 2 * object.grains->radius;
  return object.fluid ? object.fluid->spacing : 0;
}

struct Place {
  Vec3f at{};
  float distance = 0;  ///< at rest [m]
  int object = 0, particle = 0;
};

std::vector<Place> places_of(const Scene& scene) {
  std::vector<Place> all;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    const float distance = distance_at_rest(object);
    const std::size_t spare = std::min(static_cast<std::size_t>(std::max(object.flow.spare, 0)), object.positions.size());
    for (std::size_t i = 0; distance > 0 && i < object.positions.size() - spare; ++i)
      all.push_back({object.positions[i], distance, static_cast<int>(o), static_cast<int>(i)});
  }
  return all;
}

bool are_crowded(const Place& a, const Place& b) {
  const float most = crowded_share * std::min(a.distance, b.distance);
  return length_squared(a.at - b.at) < most * most;
}

/// For each place, one of a smaller number that is too near it; -1: none.
std::vector<int> find_crowded(const std::vector<Place>& places) {
  std::vector<Record> points;
  float reach = 0;
  for (const auto& [at, distance, object, particle] : places) {
    points.push_back({at.x, at.y, at.z, 0});
    reach = std::max(reach, crowded_share * distance);
  }
  std::vector<int> found(places.size(), -1);
  if (places.empty()) return found;
  Executor executor(1);
  CellOrder order;
  order.sort(executor, points, reach);
  std::vector<SlotRange> ranges;
  const Vec3f margin{reach, reach, reach};
  for (std::size_t i = 0; i < places.size(); ++i) {
    order.find(places[i].at - margin, places[i].at + margin, ranges);
    for (const SlotRange& range : ranges)
      for (std::int32_t slot = range.first; slot < range.last && found[i] < 0; ++slot) {
        const auto other = static_cast<std::size_t>(order.points()[static_cast<std::size_t>(slot)]);
        if (other < i && are_crowded(places[i], places[other])) found[i] = static_cast<int>(other);
      }
  }
  return found;
}

void doubt_emitters(Problems& problems, const Object& object) {
  for (std::size_t e = 0; e < object.flow.emitters.size(); ++e) {
    const Emitter& emitter = object.flow.emitters[e];
    const float speed = emitter.flow > 0 ? layer_of(emitter, object).speed : 0;
    if (speed > fast_jet)
      problems.doubtful("emitter " + std::to_string(e) + " ('" + emitter.name + "')",
                        "needs " + words(std::round(static_cast<double>(speed))) + " m/s for its flow of " +
                            words(static_cast<double>(emitter.flow)) + " m^3/s",
                        "flows are in m^3/s, a litre a second is 0.001; else make the opening larger");
  }
}

}  // namespace

void doubt_flows(Problems& problems, const Scene& scene) {
  const std::vector<Place> places = places_of(scene);
  const std::vector<int> near = find_crowded(places);
  std::vector<Tally> crowded(scene.objects.size());
  std::vector<int> other(scene.objects.size(), -1);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (near[i] < 0) continue;
    const auto object = static_cast<std::size_t>(places[i].object);
    if (crowded[object].count == 0) other[object] = near[i];
    crowded[object].add(places[i].particle);
  }
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    problems.at(object.name);
    doubt_emitters(problems, object);
    if (crowded[o].count == 0) continue;
    const Place& first = places[static_cast<std::size_t>(other[o])];
    const std::string& of = scene.objects[static_cast<std::size_t>(first.object)].name;
    problems.doubtful(crowded[o], "particle",
                      "starts within half the distance at rest of another one, particle " + std::to_string(first.particle) +
                          " of '" + of + "'",
                      "it is pushed away in the first frame; let fills not overlap");
  }
  problems.at("");
}

}  // namespace pliant
