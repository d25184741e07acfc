#include "solver/bodies/point_depenetration.h"

#include <algorithm>
#include <map>

#include "math/vector.h"
#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// What rests on a body with a thickness of 0 is inside by rounding: up to this share of half of the body's thickness.
constexpr float resting_share = 1e-3f;

bool is_of_a_point(const Contact& c) { return c.weight[1] == 0 && c.weight[2] == 0 && c.weight[3] == 0; }

}  // namespace

TouchedSolid PointDepenetration::solid_of(const BodySolids& solids, int solid) const {
  const MovingCollider& moving = solids.moving()[at(solid)];
  return {moving, &shapes_[at(solid)], moving.thickness};
}

/// Finds what is deep inside, and where it goes.
void PointDepenetration::find(const Substep& s, const BodySolids& solids, const std::vector<Contact>& contacts) {
  inside_.clear();
  std::map<std::pair<int, int>, Inside> all;
  for (const Contact& c : contacts) {
    const int object = s.model.object_of(c.point[0]);
    // What is around the bones of its own object is to stay there.
    if (!is_of_a_point(c) || object == solids.body_of(c).object || !has_elements(s.model.objects[at(object)])) continue;
    const TouchedSolid solid = solid_of(solids, c.collider);
    const Vec3f place = to_local(solid.moving.before, xyz(s.state.positions[at(c.point[0])]));
    if (!(distance_from(solid, place) < 0)) continue;
    Inside& inside = all[{object, c.collider}];
    inside.way.object = object;
    inside.way.solid = c.collider;
    inside.points.push_back(c.point[0]);
  }
  std::vector<Vec3f> places;
  for (auto& [key, inside] : all) {
    const TouchedSolid solid = solid_of(solids, inside.way.solid);
    const Posef& pose = solid.moving.before;
    places.clear();
    for (const int point : inside.points) places.push_back(to_local(pose, xyz(s.state.positions[at(point)])));
    const float thickness = thickness_of(s.model.objects[at(inside.way.object)], solid.moving);
    const Vec3f down = rotate(conjugate(pose.rotation), unit_or(s.model.gravity, Vec3f{}));
    if (!find_way_out(solid, places, thickness, down, resting_share, inside.way)) continue;
    std::sort(inside.points.begin(), inside.points.end());
    inside.points.erase(std::unique(inside.points.begin(), inside.points.end()), inside.points.end());
    inside_.push_back(std::move(inside));
  }
}

bool PointDepenetration::leads_out(const Substep& s, const BodySolids& solids, const Contact& c) const {
  if (inside_.empty()) return false;
  const int object = s.model.object_of(c.point[0]);
  return std::any_of(inside_.begin(), inside_.end(), [&](const Inside& inside) {
    return inside.way.solid == c.collider && inside.way.object == object &&
           holds_back(solid_of(solids, c.collider), inside.way, c, relative(c, s.state.positions.data()));
  });
}

void PointDepenetration::replace(const Substep& s, const BodySolids& solids, std::vector<Contact>& contacts) {
  find(s, solids, contacts);
  if (inside_.empty()) return;
  std::erase_if(contacts, [&](const Contact& c) { return leads_out(s, solids, c); });
  for (const Inside& inside : inside_) {
    const TouchedSolid solid = solid_of(solids, inside.way.solid);
    const float thickness = thickness_of(s.model.objects[at(inside.way.object)], solid.moving);
    contacts.reserve(contacts.size() + inside.points.size());
    for (const int point : inside.points) {
      Contact c = contact_along(solid, inside.way, xyz(s.state.positions[at(point)]), thickness, s.h);
      c.point = {point, point, point, point};
      complete_contact(c, s.state.positions.data(), s.state.remainders.data());
      contacts.push_back(c);
    }
  }
}

void PointDepenetration::warn(const Substep& s, const BodySolids& solids, std::vector<std::string>& warnings) const {
  for (const Inside& inside : inside_) {
    const TouchedBody& body = solids.bodies()[at(solids.body_of_solid()[at(inside.way.solid)])];
    const CompiledObject& other = s.model.objects[at(body.object)];
    warnings.push_back(words_of_start(s.model, inside.way.object, inside.points.front(), inside.points.size(),
                                      words_of_body(other.bodies, body.body, other.name)));
  }
}

}  // namespace pliant
