// Leaves out the particles of fills that would overlap what is solid in the scene.
#include <algorithm>

#include "pliant/liquid.h"
#include "scene_build.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

/// What the particles will be, whose object has no properties yet.
LeaveOutOptions leave_out_options_of(const JsonValue& at, const Object& object) {
  LeaveOutOptions options{object.thickness, object.groups, object.mask, object.collides};
  set(at, "thickness", options.radius);
  set(at, "groups", options.groups);
  set(at, "mask", options.mask);
  set(at, "collides", options.collides);
  return options;
}

/// "'a', 'b' and 3 more".
std::string names_of_solids(const std::vector<PlacesInSolid>& left_out) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, left_out.size()); ++i)
    text += (i == 0 ? "'" : ", '") + printable(left_out[i].in) + "'";
  return text + (left_out.size() > most ? " and " + std::to_string(left_out.size() - most) + " more" : "");
}

/// Puts particles at places. The object keeps its capacity: those that are left out can be emitted.
void put_at(const std::vector<Vec3f>& places, bool has_capacity, Object& object) {
  const std::size_t all = object.positions.size(), spare = static_cast<std::size_t>(object.flow.spare);
  const std::size_t left_out = all - spare - places.size();
  const Vec3f waits_at = spare > 0                       ? object.positions.back()
                         : !object.flow.emitters.empty() ? object.flow.emitters.front().position
                                                         : object.positions.front();
  object.positions = places;
  if (has_capacity) {
    object.flow.spare += static_cast<int>(left_out);
    object.positions.resize(all, waits_at);
  }
  object.masses.resize(object.positions.size());  // all are equal
}

}  // namespace

void leave_out(const JsonDocument& document, const JsonValue& at, const JsonValue& fill, const Scene& around,
               Object& object, std::vector<std::string>& left_out) {
  const LeaveOutOptions options = leave_out_options_of(at, object);
  if (!(options.radius > 0)) return;
  const std::size_t before = object.positions.size() - static_cast<std::size_t>(object.flow.spare);
  std::vector<Vec3f> places(object.positions.begin(), object.positions.begin() + static_cast<std::ptrdiff_t>(before));
  const std::vector<PlacesInSolid> found = leave_out_solids(places, around, options);
  if (found.empty()) return;
  if (places.empty() && object.flow.emitters.empty())
    document.fail(fill, "all of its " + std::to_string(before) + " particles would overlap " + names_of_solids(found),
                  "move one of them, or keep the particles by \"leave_out_solids\": false");
  left_out.push_back("object '" + object.name + "': " + std::to_string(before - places.size()) + " of the " +
                     std::to_string(before) + " particles of its fill, which would overlap " + names_of_solids(found));
  put_at(places, object.flow.spare > 0 || !object.flow.emitters.empty(), object);
}

}  // namespace pliant::scene_file
