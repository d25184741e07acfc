// Warnings about liquids, gases and grains: particles that start within one another, emitters that shoot, and numbers
// of no known matter.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "collision/neighbours/cell_order.h"
#include "inspect/problems.h"

namespace pliant {

namespace {

/// Particles of liquids nearer than this share of the smaller distance at which they rest push each other away in the
/// first frame. Grains that are nearer than this share of their diameter have contact, which throws them apart.
constexpr float crowded_share = 0.5f, overlapping_share = 0.95f;
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
  bool is_grain = false;

  /// The distance below which two are too near [m].
  float least_distance() const { return (is_grain ? overlapping_share : crowded_share) * distance; }
};

std::vector<Place> places_of(const Scene& scene) {
  std::vector<Place> all;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    const float distance = distance_at_rest(object);
    const std::size_t spare =
        std::min(static_cast<std::size_t>(std::max(object.flow.spare, 0)), object.positions.size());
    for (std::size_t i = 0; distance > 0 && i < object.positions.size() - spare; ++i)
      all.push_back(
          {object.positions[i], distance, static_cast<int>(o), static_cast<int>(i), object.grains.has_value()});
  }
  return all;
}

bool are_crowded(const Place& a, const Place& b) {
  // Grains of two sizes touch at the mean of both diameters.
  const float most = a.is_grain && b.is_grain ? 0.5f * (a.least_distance() + b.least_distance())
                                              : crowded_share * std::min(a.distance, b.distance);
  return length_squared(a.at - b.at) < most * most;
}

/// For each place, one of a smaller number that is too near it; -1: none.
std::vector<int> find_crowded(const std::vector<Place>& places) {
  std::vector<Record> points;
  float reach = 0;
  for (const Place& place : places) {
    points.push_back({place.at.x, place.at.y, place.at.z, 0});
    reach = std::max(reach, place.least_distance());
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

/// A temperature that is probably in degrees Celsius, or mistyped. Flames have up to 3 500 K.
void doubt_temperature(Problems& problems, const std::string& what, float temperature) {
  constexpr float coldest = 100, hottest = 10000;  // [K]
  if (temperature >= coldest && temperature <= hottest) return;
  problems.doubtful(
      what,
      "is " + words(static_cast<double>(temperature)) +
          (temperature < coldest ? " K, at which air is frozen" : " K, hotter than the surface of the sun"),
      "temperatures are in kelvin: 20 degrees Celsius are 293.15");
}

/// Numbers of a liquid or gas that are outside of what exists by far.
void doubt_matter(Problems& problems, const Object& object) {
  constexpr double lightest = 1, stiffest = 1e4;  // of liquids [kg/m^3]; kinematic viscosity [m^2/s], of pitch 1e5
  if (!object.fluid) return;
  const double density = static_cast<double>(object.fluid->density),
               viscosity = static_cast<double>(object.fluid->viscosity);
  if (!object.gas && density < lightest)
    problems.doubtful("fluid, density", "is " + words(density) + " kg/m^3, less than that of air",
                      "densities are in kg/m^3: water has 1000");
  if (viscosity > stiffest * density)
    problems.doubtful(
        "fluid, viscosity",
        "is " + words(viscosity) + " Pa s at a density of " + words(density) + " kg/m^3, so that it moves like a solid",
        "viscosities are in Pa s: water has 0.001, honey 10");
  if (!object.gas) return;
  doubt_temperature(problems, "gas, temperature", object.gas->temperature);
  doubt_temperature(problems, "gas, ambient_temperature", object.gas->ambient_temperature);
  for (const GasHeater& heater : object.gas->heaters)
    doubt_temperature(problems, "gas, heater, temperature", heater.temperature);
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
    doubt_matter(problems, object);
    if (crowded[o].count == 0) continue;
    const Place& first = places[static_cast<std::size_t>(other[o])];
    const std::string& of = scene.objects[static_cast<std::size_t>(first.object)].name;
    problems.doubtful(
        crowded[o], "particle",
        std::string(object.grains && first.is_grain ? "starts nearer to another grain than they touch"
                                                    : "starts within half the distance at rest of another one") +
            ", particle " + std::to_string(first.particle) + " of '" + of + "'",
        "it is pushed away in the first frame; let fills not overlap");
  }
  problems.at("");
}

}  // namespace pliant
