#include "solver/bodies/point_depenetration.h"

#include <algorithm>
#include <map>

#include "math/vector.h"
#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// The speed of the separation, as of other surfaces [m/s].
constexpr float depenetration_speed_of_points = 1;
/// What is deeper than this share of the solid's half thickness is moved as a whole.
constexpr float share_of_half_thickness = 0.3f;
/// Nearer to a surface it is so as well if the way out is at most so many times the depth: where the ways of all points
/// differ, as those of a belt around a body do, the nearest side of each is right.
constexpr float most_ways_over_depth = 1.5f;
/// A way down, into the ground, counts as so many times as long.
constexpr float length_of_way_down = 2;

/// The distance of a point in the frame of a solid from its surface [m].
float distance_from(const MovingCollider& solid, const Vec3f& at) {
  if (solid.field != nullptr) return solid.field->distance(at).distance - solid.thickness;
  return signed_distance(solid.shape, at).distance;
}

/// How far a solid reaches from the origin of its frame along a direction [m].
float reach_to(const ConvexShape& shape, const Vec3f& direction) {
  const Vec3d to = convert<double>(direction);
  return static_cast<float>(dot(support(shape, to), to)) + shape.radius;
}

/// The directions in which something can leave a solid, in its frame.
std::vector<Vec3f> ways_out(const ConvexShape& shape, const Vec3f& middle) {
  std::vector<Vec3f> ways{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {-1, 0, 0}, {0, 0, -1}};
  if (shape.kind == ConvexShape::Kind::polyhedron) {
    ways.assign(shape.polyhedron->normals.begin(), shape.polyhedron->normals.end());
    return ways;
  }
  const Vec3f away = shape.kind == ConvexShape::Kind::point ? middle : Vec3f{middle.x, 0, middle.z};
  if (length(away) > 0) ways.push_back(unit_or(away, Vec3f{0, 1, 0}));
  return ways;
}

/// What is inside of a solid, in its frame.
struct Within {
  std::vector<Vec3f> places;
  float deepest = 0;  ///< distance of the deepest from the surface [m]
};

/// The shortest way out of a solid for all that is within.
struct WayOut {
  Vec3f direction{};
  float way = 0, half_thickness = 1e30f;
};

/// `down`: the direction of gravity in the frame of the solid; ways along it count more. Ways that differ by a
/// twentieth are alike, and the one that is most against gravity is taken, so that symmetric ones do not take turns.
WayOut shortest_way(const ConvexShape& shape, const Within& within, const Vec3f& down) {
  Vec3f middle{};
  for (const Vec3f& place : within.places) middle += place * (1 / static_cast<float>(within.places.size()));
  WayOut out;
  float least = 1e30f;
  for (const Vec3f& n : ways_out(shape, middle)) {
    float lowest = 1e30f;
    for (const Vec3f& place : within.places) lowest = min(lowest, dot(n, place));
    const float reach = reach_to(shape, n), way = reach - lowest, fall = dot(n, down);
    out.half_thickness = min(out.half_thickness, 0.5f * (reach + reach_to(shape, -n)));
    const float cost = way * (fall > 0.5f ? length_of_way_down : 1.f + 0.05f * fall);
    if (!(cost < least)) continue;
    least = cost;
    out.direction = n;
    out.way = way;
  }
  return out;
}

bool has_elements(const CompiledObject& object) { return !object.surface.triangles.empty() || !object.lines.empty(); }

bool is_of_a_point(const Contact& c) { return c.weight[1] == 0 && c.weight[2] == 0 && c.weight[3] == 0; }

/// The contact that moves a point along a direction in a solid's frame until it is outside.
Contact contact_along(const Substep& s, const MovingCollider& solid, int number, const Vec3f& direction, float reach,
                      int point) {
  const CompiledObject& object = s.model.objects[at(s.model.object_of(point))];
  const Vec3f position = xyz(s.state.positions[at(point)]), start = to_local(solid.before, position);
  const float above = dot(direction, start) - reach;
  const Vec3f surface = start - direction * above;
  Contact c;
  c.point = {point, point, point, point};
  c.weight = {1, 0, 0, 0};
  c.thickness = thickness_of(object, solid);
  c.collider = number;
  c.normal = rotate(solid.after.rotation, direction);
  c.gap = dot(c.normal, position - to_world(solid.after, surface)) -
          min(c.thickness, above + depenetration_speed_of_points * s.h);
  c.surface_motion = to_world(solid.after, surface) - to_world(solid.before, surface);
  complete_contact(c, s.state.positions.data(), s.state.remainders.data());
  return c;
}

}  // namespace

/// Finds what is deep inside, and where it goes.
void PointDepenetration::find(const Substep& s, const BodySolids& solids, const std::vector<Contact>& contacts) {
  inside_.clear();
  directions_.clear();
  std::map<std::pair<int, int>, Inside> all;
  for (const Contact& c : contacts) {
    const int object = s.model.object_of(c.point[0]);
    // What is around the bones of its own object is to stay there.
    if (!is_of_a_point(c) || object == solids.body_of(c).object || !has_elements(s.model.objects[at(object)])) continue;
    const MovingCollider& solid = solids.moving()[at(c.collider)];
    const Vec3f place = to_local(solid.before, xyz(s.state.positions[at(c.point[0])]));
    if (!(distance_from(solid, place) < 0)) continue;
    Inside& inside = all[{object, c.collider}];
    inside.object = object;
    inside.solid = c.collider;
    inside.points.push_back(c.point[0]);
  }
  for (auto& [key, inside] : all) {
    const MovingCollider& solid = solids.moving()[at(inside.solid)];
    Within within;
    within.places.reserve(inside.points.size());
    for (const int point : inside.points) {
      within.places.push_back(to_local(solid.before, xyz(s.state.positions[at(point)])));
      within.deepest = max(within.deepest, -distance_from(solid, within.places.back()));
    }
    const float thickness = thickness_of(s.model.objects[at(inside.object)], solid);
    if (!(within.deepest > thickness)) continue;
    const Vec3f down = rotate(conjugate(solid.before.rotation), unit_or(s.model.gravity, Vec3f{}));
    const WayOut out = shortest_way(shapes_[at(inside.solid)], within, down);
    if (!(within.deepest > share_of_half_thickness * out.half_thickness) &&
        !(out.way < most_ways_over_depth * within.deepest))
      continue;
    std::sort(inside.points.begin(), inside.points.end());
    inside.points.erase(std::unique(inside.points.begin(), inside.points.end()), inside.points.end());
    inside_.push_back(std::move(inside));
    directions_.push_back(out.direction);
  }
}

void PointDepenetration::replace(const Substep& s, const BodySolids& solids, std::vector<Contact>& contacts) {
  find(s, solids, contacts);
  if (inside_.empty()) return;
  const auto is_replaced = [&](const Contact& c) {
    const int object = s.model.object_of(c.point[0]);
    const auto holds = [&](const Inside& inside) {
      return inside.object == object && inside.solid == c.collider &&
             std::any_of(c.point.begin(), c.point.end(), [&](int point) {
               return std::binary_search(inside.points.begin(), inside.points.end(), point);
             });
    };
    return std::any_of(inside_.begin(), inside_.end(), holds);
  };
  std::erase_if(contacts, is_replaced);
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    const Inside& inside = inside_[i];
    const float reach = reach_to(shapes_[at(inside.solid)], directions_[i]);
    contacts.reserve(contacts.size() + inside.points.size());
    for (const int point : inside.points)
      contacts.push_back(
          contact_along(s, solids.moving()[at(inside.solid)], inside.solid, directions_[i], reach, point));
  }
}

void PointDepenetration::warn(const Substep& s, const BodySolids& solids, std::vector<std::string>& warnings) const {
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    const Inside& inside = inside_[i];
    const TouchedBody& body = solids.bodies()[at(solids.body_of_solid()[at(inside.solid)])];
    const CompiledObject &object = s.model.objects[at(inside.object)], &other = s.model.objects[at(body.object)];
    const int first = object.order[at(inside.points.front() - s.model.first[at(inside.object)])];
    warnings.push_back("object '" + object.name + "', particle " + std::to_string(first) + ": is inside of " +
                       words_of_body(other.bodies, body.body, other.name) +
                       (inside.points.size() == 1 ? "" : ", one of " + std::to_string(inside.points.size())) +
                       ": it started there or was teleported there, and is moved out at 1 m/s; start them apart");
  }
}

}  // namespace pliant
