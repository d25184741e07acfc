#include "solver/ways_out.h"

#include <algorithm>

#include "core/at.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// The speed of the separation, as of other surfaces [m/s].
constexpr float depenetration_speed_of_points = 1;
/// What is deeper than this share of the solid's half thickness is moved as a whole.
constexpr float share_moved_as_a_whole = 0.3f;
/// Nearer to a surface it is so as well if the way out is at most so many times the depth: where the ways of all points
/// differ, as those of a belt around a body do, the nearest side of each is right.
constexpr float most_ways_over_depth = 1.5f;
/// A way down, into the ground, counts as so many times as long.
constexpr float length_of_way_down = 2;
/// Contacts whose normals are nearer to the way out than this are on the side on which something leaves.
constexpr float least_normal_along_way = 0.7f;
/// Through a field the ways of at most so many points are measured, in steps of at least this share of its size.
constexpr std::size_t most_measured_points = 128;
constexpr float share_of_step = 1 / 64.f;

/// How far a solid that is no field reaches from the origin of its frame along a direction [m].
float reach_to(const TouchedSolid& solid, const Vec3f& direction) {
  if (solid.convex != nullptr) {
    const Vec3d to = convert<double>(direction);
    return static_cast<float>(dot(support(*solid.convex, to), to)) + solid.convex->radius;
  }
  const LocalShape& shape = solid.moving.shape;
  if (shape.kind == ShapeKind::box) return dot(abs(direction), half_sides<float>(shape));
  return shape.kind == ShapeKind::capsule ? shape.a + shape.b * abs(direction.y) : shape.a;
}

bool is_field(const TouchedSolid& solid) { return solid.convex == nullptr && solid.moving.field != nullptr; }

/// True if a solid is round about its origin, or about the y axis of its frame.
bool is_ball(const TouchedSolid& solid) {
  return solid.convex != nullptr ? solid.convex->kind == ConvexShape::Kind::point
                                 : solid.moving.shape.kind == ShapeKind::sphere;
}
bool is_round_about_y(const TouchedSolid& solid) {
  return solid.convex != nullptr || (!is_field(solid) && solid.moving.shape.kind == ShapeKind::capsule);
}

/// The directions in which something can leave a solid, in its frame.
std::vector<Vec3f> directions_out(const TouchedSolid& solid, const Vec3f& middle) {
  std::vector<Vec3f> ways{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {-1, 0, 0}, {0, 0, -1}};
  if (solid.convex != nullptr && solid.convex->kind == ConvexShape::Kind::polyhedron) {
    ways.assign(solid.convex->polyhedron->normals.begin(), solid.convex->polyhedron->normals.end());
    return ways;
  }
  if (!is_ball(solid) && !is_round_about_y(solid)) return ways;
  const Vec3f away = is_ball(solid) ? middle : Vec3f{middle.x, 0, middle.z};
  if (length(away) > 0) ways.push_back(unit_or(away, Vec3f{0, 1, 0}));
  return ways;
}

/// The distance along a direction to the surface of a field, from a place inside [m].
float exit_along(const TouchedSolid& solid, const Vec3f& place, const Vec3f& direction) {
  const BoxBounds box = solid.moving.field->bounds();
  const float size = largest(box.high - box.low), step = share_of_step * size;
  float way = 0;
  while (way < 2 * size) {
    const float distance = distance_from(solid, place + direction * way);
    if (!(distance < 0)) break;
    way += max(-distance, step);
  }
  return way;
}

/// What is inside of a solid, in its frame.
struct Within {
  std::vector<Vec3f> places{};  ///< of those deeper than the thickness
  Vec3f middle{}, deepest_place{};
  float deepest = 0;  ///< distance of the deepest from the surface [m]
};

Within within(const TouchedSolid& solid, const std::vector<Vec3f>& places, float thickness) {
  Within out;
  for (const Vec3f& place : places) {
    out.middle += place * (1 / static_cast<float>(places.size()));
    const float depth = -distance_from(solid, place);
    if (depth > thickness) out.places.push_back(place);
    if (!(depth > out.deepest)) continue;
    out.deepest = depth;
    out.deepest_place = place;
  }
  return out;
}

/// How far all must move along a direction, and half of the solid's thickness there [m].
struct Ways {
  float way = 0, half_thickness = 0, reach = 0;
};

Ways ways_along(const TouchedSolid& solid, const Within& inside, const Vec3f& n) {
  Ways out;
  float lowest = 1e30f, highest = -1e30f;
  for (const Vec3f& place : inside.places) {
    lowest = min(lowest, dot(n, place));
    highest = max(highest, dot(n, place));
  }
  if (!is_field(solid)) {
    out.reach = reach_to(solid, n);
    out.way = out.reach - lowest;
    out.half_thickness = 0.5f * (out.reach + reach_to(solid, -n));
    return out;
  }
  const std::size_t stride = inside.places.size() / most_measured_points + 1;
  for (std::size_t i = 0; i < inside.places.size(); i += stride)
    out.way = max(out.way, exit_along(solid, inside.places[i], n));
  const Vec3f& deepest = inside.deepest_place;
  out.half_thickness = 0.5f * (exit_along(solid, deepest, n) + exit_along(solid, deepest, -n));
  out.reach = highest + out.way;
  return out;
}

}  // namespace

float distance_from(const TouchedSolid& solid, const Vec3f& place) {
  if (solid.moving.field != nullptr) return solid.moving.field->distance(place).distance - solid.margin;
  return signed_distance(solid.moving.shape, place).distance;
}

/// Ways that differ by a twentieth are alike, and the one that is most against gravity is taken, so that symmetric ones
/// do not take turns.
bool find_way_out(const TouchedSolid& solid, const std::vector<Vec3f>& places, float thickness, const Vec3f& down,
                  float least_share, WayOut& out) {
  const Within inside = within(solid, places, thickness);
  if (!(inside.deepest > thickness)) return false;
  float least = 1e30f, way = 0, half_thickness = 1e30f;
  for (const Vec3f& n : directions_out(solid, inside.middle)) {
    const Ways ways = ways_along(solid, inside, n);
    const float fall = dot(n, down);
    half_thickness = min(half_thickness, ways.half_thickness);
    const float cost = ways.way * (fall > 0.5f ? length_of_way_down : 1.f + 0.05f * fall);
    if (!(cost < least)) continue;
    least = cost;
    way = ways.way;
    out.direction = n;
    out.reach = ways.reach;
  }
  const bool is_on_one_side = way < most_ways_over_depth * inside.deepest;
  return inside.deepest > (is_on_one_side ? least_share : share_moved_as_a_whole) * half_thickness;
}

Contact contact_along(const TouchedSolid& solid, const WayOut& out, const Vec3f& position, float thickness, float h) {
  const Vec3f start = to_local(solid.moving.before, position);
  const float above = dot(out.direction, start) - out.reach;
  const Vec3f surface = start - out.direction * above;
  Contact c;
  c.weight = {1, 0, 0, 0};
  c.thickness = thickness;
  c.collider = out.solid;
  c.normal = rotate(solid.moving.after.rotation, out.direction);
  c.gap = dot(c.normal, position - to_world(solid.moving.after, surface)) -
          min(c.thickness, above + depenetration_speed_of_points * h);
  c.surface_motion = to_world(solid.moving.after, surface) - to_world(solid.moving.before, surface);
  return c;
}

bool holds_back(const TouchedSolid& solid, const WayOut& out, const Contact& contact, const Vec3f& place) {
  const Vec3f along = rotate(solid.moving.after.rotation, out.direction);
  return !(dot(contact.normal, along) > least_normal_along_way) ||
         distance_from(solid, to_local(solid.moving.before, place)) < 0;
}

bool has_elements(const CompiledObject& object) { return !object.surface.triangles.empty() || !object.lines.empty(); }

std::string words_of_start(const Model& model, int object, int first, std::size_t points, const std::string& what) {
  const CompiledObject& of = model.objects[at(object)];
  return "object '" + of.name + "', particle " + std::to_string(of.order[at(first - model.first[at(object)])]) +
         ": is inside of " + what + (points == 1 ? "" : ", one of " + std::to_string(points)) +
         ": it started there or was teleported there, and is moved out at 1 m/s; start them apart";
}

float fastest_of(const MovingCollider& solid, float h) {
  const Quatf turn = multiply(conjugate(solid.before.rotation), solid.after.rotation);
  Vec3f corner = half_sides<float>(solid.shape);
  if (solid.field != nullptr) corner = max(abs(solid.field->bounds().low), abs(solid.field->bounds().high));
  const float chord = 2 * length(Vec3f{turn.x, turn.y, turn.z});
  return (length(solid.after.position - solid.before.position) + (chord > 0 ? chord * length(corner) : 0.f)) / h;
}

}  // namespace pliant
