// Warnings about liquids, gases and grains: particles that start within one another, and emitters that shoot.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

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

/// Places by cells, in which those that are too near each other are in the same cell or the next.
class Cells {
 public:
  explicit Cells(const std::vector<Place>& places) : places_(places) {
    for (const Place& place : places) size_ = std::max(size_, crowded_share * place.distance);
    for (std::size_t i = 0; i < places.size(); ++i) cells_[key(cell_of(places[i].at))].push_back(static_cast<int>(i));
  }

  /// A place that is too near the one with this number, of a smaller number; -1: none.
  int near(int number) const {
    const Place& place = places_[static_cast<std::size_t>(number)];
    const std::array<std::int64_t, 3> cell = cell_of(place.at);
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto found = cells_.find(key({cell[0] + x, cell[1] + y, cell[2] + z}));
          if (found == cells_.end()) continue;
          for (const int other : found->second)
            if (other < number && are_crowded(place, places_[static_cast<std::size_t>(other)])) return other;
        }
    return -1;
  }

 private:
  static bool are_crowded(const Place& a, const Place& b) {
    const float most = crowded_share * std::min(a.distance, b.distance);
    return length_squared(a.at - b.at) < most * most;
  }
  std::array<std::int64_t, 3> cell_of(const Vec3f& p) const {
    const auto along = [&](float x) { return static_cast<std::int64_t>(std::floor(static_cast<double>(x / size_))); };
    return {along(p.x), along(p.y), along(p.z)};
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& cell) {
    std::uint64_t sum = 0;
    for (const std::int64_t number : cell) sum = (sum ^ static_cast<std::uint64_t>(number)) * 0x9e3779b97f4a7c15u;
    return sum;
  }

  const std::vector<Place>& places_;
  float size_ = 0;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

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
  const Cells cells(places);
  std::vector<Tally> crowded(scene.objects.size());
  std::vector<int> other(scene.objects.size(), -1);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const int found = cells.near(static_cast<int>(i));
    if (found < 0) continue;
    const auto object = static_cast<std::size_t>(places[i].object);
    if (crowded[object].count == 0) other[object] = found;
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
