#include "solver/collider_depenetration.h"

#include <algorithm>
#include <map>
#include <utility>

#include "math/record.h"

namespace pliant {

namespace {

/// How much faster than the solid the object may be that is led out of it [m/s].
constexpr float speed_beside_solid = 2;
/// Cloth that is pressed on a collider goes in by up to this share of half of the collider's thickness.
constexpr float pressed_share = 0.1f;
/// Edges and triangles that are deeper than this share of half a solid's thickness have not been pressed in by others.
constexpr float share_of_half_thickness = 0.3f;
/// Contacts of what overlaps more than this speed undoes ask for less than their thickness [m/s].
constexpr float least_motion_out = 0.95f * largest_separation_speed;

/// The collider of contacts that are dropped.
constexpr std::int32_t dropped = -1;

/// True if ways out of a collider differ from place to place.
bool has_sides(const MovingCollider& collider) {
  return collider.field != nullptr ? !collider.field->is_ground() : collider.shape.kind != ShapeKind::plane;
}

bool is_inside(const MovingCollider& collider, const Record& position) {
  return distance_from({collider}, to_local(collider.before, xyz(position))) < 0;
}

BoundingBox<float> box_around(const Record* positions, int first, int last) {
  Vec3f low{3e38f, 3e38f, 3e38f}, high = -low;
  for (int i = first; i < last; ++i) {
    low = min(low, xyz(positions[i]));
    high = max(high, xyz(positions[i]));
  }
  return {low, high};
}

/// Finds the particles of a tile that are inside of a collider, by collider.
void find_inside(const Substep& s, int task, std::vector<std::pair<int, int>>& inside) {
  inside.clear();
  const CompiledObject& object = object_of(s, task);
  if (object.is_collider || !has_elements(object)) return;
  const AdvanceArguments a = particles(s, task);
  const BoundingBox<float> box = box_around(a.positions, a.first, a.last);
  for (std::size_t c = 0; c < s.own->colliders.size(); ++c) {
    const MovingCollider& collider = s.own->colliders[c];
    const Vec3f apart = max(box.low - collider.swept.high, collider.swept.low - box.high);
    if (!has_sides(collider) || max(max(apart.x, apart.y), apart.z) > 0 || !meet(object, collider)) continue;
    for (int i = a.first; i < a.last; ++i)
      if (!object.bodies.has_centre(i) && is_inside(collider, a.positions[i]))
        inside.emplace_back(static_cast<int>(c), i);
  }
}

/// What is inside of one collider of one object.
struct PointsInside {
  std::vector<Vec3f> places;
  std::vector<int> points;  ///< of the State
  bool is_held = false;     ///< true if one of the points is fixed
};

}  // namespace

void find_points_inside(Substep& s) {
  if (s.made > 0) return;
  s.ways_out.clear();
  const std::vector<MovingCollider>& colliders = s.own->colliders;
  if (std::none_of(colliders.begin(), colliders.end(), has_sides)) return;
  for_tiles(s, "find what is inside", [&](int task) { find_inside(s, task, s.work.tiles[task].inside); });
  std::map<std::pair<int, int>, PointsInside> all;
  for_each_tile(s, [&](int task) {
    const int object = s.model.tiles()[task].object;
    for (const auto& [collider, i] : s.work.tiles[task].inside) {
      PointsInside& inside = all[{object, collider}];
      const Record& position = s.state.positions[at(s.model.first[at(object)] + i)];
      inside.places.push_back(to_local(colliders[at(collider)].before, xyz(position)));
      inside.points.push_back(s.model.first[at(object)] + i);
      inside.is_held = inside.is_held || !(position.w > 0);
    }
  });
  for (const auto& [key, inside] : all) {
    const auto& [object, number] = key;
    const MovingCollider& collider = colliders[at(number)];
    const float thickness = material_of(s.model.objects[at(object)], collider).thickness;
    const Vec3f down = rotate(conjugate(collider.before.rotation), unit_or(s.model.gravity, Vec3f{}));
    WayOut way{object, number};
    if (inside.is_held || !find_way_out({collider}, inside.places, thickness, down, pressed_share, way)) continue;
    s.ways_out.push_back(way);
    const auto primitives = static_cast<int>(s.model.colliders.size());
    const std::string& name = number < primitives
                                  ? s.model.colliders[at(number)].name
                                  : s.model.objects[at(s.model.fields[at(number - primitives)].object)].name;
    const int first = *std::min_element(inside.points.begin(), inside.points.end());
    s.report.warnings.push_back(
        words_of_start(s.model, object, first, inside.points.size(), "collider '" + name + "'"));
  }
}

namespace {

/// The way out of a contact's collider for the points of an object; null if there is none.
const WayOut* way_of(const Substep& s, int object, const Contact& c) {
  const auto is_of = [&](const WayOut& way) { return way.object == object && way.solid == c.collider; };
  const auto found = std::find_if(s.ways_out.begin(), s.ways_out.end(), is_of);
  return found == s.ways_out.end() ? nullptr : &*found;
}

}  // namespace

void follow_ways_out(const Substep& s, int task, std::vector<Contact>& contacts) {
  if (s.ways_out.empty()) return;
  const AdvanceArguments a = particles(s, task);
  for (Contact& c : contacts) {
    const WayOut* const way = way_of(s, s.model.tiles()[task].object, c);
    if (way == nullptr) continue;
    const MovingCollider& collider = s.own->colliders[at(c.collider)];
    const Record& position = a.positions[c.point[0]];
    if (!is_inside(collider, position)) {
      if (holds_back({collider}, *way, c, xyz(position))) c.collider = dropped;
      continue;
    }
    const auto point = c.point;
    c = contact_along({collider}, *way, xyz(position), c.thickness, s.h);
    c.point = point;
    complete_contact(c, a.positions, a.remainders);
  }
  std::erase_if(contacts, [](const Contact& c) { return c.collider == dropped; });
}

void drop_elements_inside(const Substep& s, std::vector<Contact>& contacts) {
  if (s.ways_out.empty()) return;
  std::erase_if(contacts, [&](const Contact& c) {
    const WayOut* const way = way_of(s, s.model.object_of(c.point[0]), c);
    return way != nullptr &&
           holds_back({s.own->colliders[at(c.collider)]}, *way, c, relative(c, s.state.positions.data()));
  });
}

namespace {

void limit_to(const Substep& s, int object, const MovingCollider& solid) {
  std::vector<SpeedLimit>& limits = s.own->speed_limits;
  const float most = speed_beside_solid + fastest_of(solid, s.h);
  const auto same = std::find_if(limits.begin(), limits.end(), [&](const SpeedLimit& l) { return l.object == object; });
  if (same != limits.end()) {
    same->most = max(same->most, most);
  } else {
    limits.push_back({object, most, {}});
  }
}

/// The same for the objects of edges and triangles that pass through a solid, deeper than their thickness and than a
/// share of its own; not of fields, which have no sides. Not at bodies: what a fast one hits is as deep for a moment, and
/// their momentum is kept.
void limit_elements(const Substep& s) {
  for (const Contact& c : s.own->shape_contacts) {
    if (!(c.gap < -least_motion_out * s.h) || c.weight[1] == 0) continue;
    const MovingCollider& solid = s.own->colliders[at(c.collider)];
    const Vec3f place = to_local(solid.before, relative(c, s.state.positions.data()));
    const Vec3f half = half_sides<float>(solid.shape);
    const float deep = max(c.thickness, share_of_half_thickness * min(half.x, min(half.y, half.z)));
    if (distance_from({solid}, place) < -deep) limit_to(s, s.model.object_of(c.point[0]), solid);
  }
}

}  // namespace

void note_speeds(Substep& s) {
  std::vector<SpeedLimit>& limits = s.own->speed_limits;
  limits.clear();
  for (const WayOut& way : s.ways_out) limit_to(s, way.object, s.own->colliders[at(way.solid)]);
  if (!s.own->colliders.empty()) limit_elements(s);
  for (SpeedLimit& limit : limits) {
    const Vec3f gained = gravity_for(s, s.work.gravity[at(limit.object)].begun);
    const auto first = s.state.velocities.begin() + s.model.first[at(limit.object)];
    const auto last = first + s.model.objects[at(limit.object)].particles;
    limit.speeds.reserve(at(static_cast<int>(last - first)));
    for (auto v = first; v != last; ++v) limit.speeds.push_back(length(xyz(*v) + gained));
  }
}

void limit_speeds(Substep& s, FunctionRef<Vec3f(int object)> missing) {
  for (const SpeedLimit& limit : s.own->speed_limits) {
    const Vec3f lacks = missing(limit.object);
    const CompiledBodies& bodies = s.model.objects[at(limit.object)].bodies;
    Vec3f lost{};
    Record* const velocities = s.state.velocities.data() + s.model.first[at(limit.object)];
    const Record* const positions = s.state.positions.data() + s.model.first[at(limit.object)];
    for (std::size_t i = 0; i < limit.speeds.size(); ++i) {
      const Vec3f velocity = xyz(velocities[i]) + lacks;
      const float is = length(velocity), most = max(limit.speeds[i], limit.most);
      if (positions[i].w == 0 || !(is > most) || bodies.has_centre(static_cast<int>(i))) continue;
      const Vec3f kept = velocity * (most / is) - lacks;
      lost += (velocity - lacks - kept) * (1 / positions[i].w);
      velocities[i] = {kept.x, kept.y, kept.z, velocities[i].w};
    }
    s.report.lost_momentum.guards += length(lost);
  }
}

}  // namespace pliant
