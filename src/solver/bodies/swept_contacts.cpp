#include "solver/bodies/swept_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// A motion below this share of a solid's smallest half side is seen by contacts at the substep's end.
constexpr float motion_over_half_side = 0.5f;
/// Room for rounding at the edges of a triangle, in barycentric coordinates.
constexpr float beside = 1e-3f;
/// Times are found to 1e-6 of a substep.
constexpr int time_bisections = 20;
/// Hits of neighbouring triangles at an edge are taken together if they are this near in time.
constexpr float same_time = 1e-3f;

/// Half sides of the box about a solid's centre, without its margin.
Vec3f half_sides_of(const MovingCollider& solid) {
  if (solid.field != nullptr) return (solid.field->bounds().high - solid.field->bounds().low) * 0.5f;
  const LocalShape& shape = solid.shape;
  if (shape.kind == ShapeKind::sphere) return {shape.a, shape.a, shape.a};
  if (shape.kind == ShapeKind::capsule) return {shape.a, shape.a + shape.b, shape.a};
  return {shape.a, shape.b, shape.c};
}

Vec3f centre_of(const MovingCollider& solid, const Pose<float>& pose) {
  if (solid.field == nullptr) return pose.position;
  return to_world(pose, (solid.field->bounds().low + solid.field->bounds().high) * 0.5f);
}

/// How far the solid reaches from its centre along a direction at the substep's end [m].
float reach_along(const MovingCollider& solid, const Vec3f& direction) {
  const Vec3f half = half_sides_of(solid), local = abs(rotate(conjugate(solid.after.rotation), direction));
  if (solid.field == nullptr && solid.shape.kind == ShapeKind::sphere) return half.x + solid.thickness;
  if (solid.field == nullptr && solid.shape.kind == ShapeKind::capsule)
    return solid.shape.a + solid.shape.b * local.y + solid.thickness;
  return dot(half, local) + solid.thickness;
}

float smallest(const Vec3f& v) { return min(v.x, min(v.y, v.z)); }

struct Corners {
  Vec3f at[3];
  Vec3f normal() const { return cross(at[1] - at[0], at[2] - at[0]); }
};

/// Corners and a point that move steadily from time 0 to 1.
struct Passing {
  Corners start, end;
  Vec3f from{}, to{};

  Corners corners(float time) const {
    Corners out;
    for (std::size_t i = 0; i < 3; ++i) out.at[i] = start.at[i] + (end.at[i] - start.at[i]) * time;
    return out;
  }
  Vec3f point(float time) const { return from + (to - from) * time; }
  /// Zero where the point lies in the triangle's plane, of different signs on both sides.
  float side(float time) const {
    const Corners there = corners(time);
    return dot(there.normal(), point(time) - there.at[0]);
  }
  /// When the point passes the plane, if it does. A triangle that turns on its way makes side() a cubic, so the root is
  /// bracketed.
  float time() const {
    float low = 0, high = 1;
    const float before = side(0);
    for (int i = 0; i < time_bisections; ++i) {
      const float middle = 0.5f * (low + high);
      (side(middle) * before > 0 ? low : high) = middle;
    }
    return 0.5f * (low + high);
  }
};

/// Barycentric coordinates of a point in the plane of a triangle.
Vec3f coordinates(const Corners& t, const Vec3f& p) {
  const Vec3f n = t.normal();
  const float inverse = 1 / max(dot(n, n), 1e-30f);
  const float v = dot(n, cross(p - t.at[0], t.at[2] - t.at[0])) * inverse,
              w = dot(n, cross(t.at[1] - t.at[0], p - t.at[0])) * inverse;
  return {1 - v - w, v, w};
}

}  // namespace

/// Finds the triangles of a tile that the centre of a solid passes.
void SweptContacts::find_hits(const Substep& s, const SurfaceTile& tile, const MovingCollider& solid, Found& found) {
  const Vec3f from = centre_of(solid, solid.before), to = centre_of(solid, solid.after);
  const Vec3f by = Vec3f{1, 1, 1} * tile.fastest;
  const Vec3f low = min(from, to) - by, high = max(from, to) + by;
  for (const std::array<int, 3>& t : tile.elements) {
    Passing passing{{}, {}, from, to};
    Corners &start = passing.start, &end = passing.end;
    for (std::size_t i = 0; i < 3; ++i) start.at[i] = xyz(s.state.positions[at(t[i])]);
    const Vec3f least = min(start.at[0], min(start.at[1], start.at[2])),
                most = max(start.at[0], max(start.at[1], start.at[2]));
    if (least.x > high.x || least.y > high.y || least.z > high.z || most.x < low.x || most.y < low.y || most.z < low.z)
      continue;
    for (std::size_t i = 0; i < 3; ++i) end.at[i] = start.at[i] + xyz(s.work.displacements[at(t[i])]);
    const Vec3f n = start.normal();
    const float before = dot(n, from - start.at[0]), after = dot(end.normal(), to - end.at[0]);
    if (!(before * after < 0) && after != 0) continue;
    const float time = passing.time();
    const Vec3f weights = coordinates(passing.corners(time), passing.point(time));
    if (!(smallest(weights) > -beside)) continue;
    const float size = length(n);
    if (size > 0) found.hits.push_back({tile.object, t, time, weights, n * ((before > 0 ? -1.f : 1.f) / size)});
  }
}

void SweptContacts::detect_solid(const Substep& s, const SurfaceTiles& surfaces, const MovingCollider& solid,
                                 int number, const FunctionRef<bool(const Contact&)>& meets) {
  Found& found = found_[at(number)];
  found.hits.clear();
  found.contacts.clear();
  found.is_fast = false;
  const Vec3f from = centre_of(solid, solid.before), to = centre_of(solid, solid.after);
  const float path = length(to - from), size = motion_over_half_side * smallest(half_sides_of(solid));
  const BoxBounds of_path{min(from, to), max(from, to)};  // of the centre, which alone is tested
  for (const int t : surfaces.tiles_near(number)) {
    const SurfaceTile& tile = surfaces.tiles()[at(t)];
    if (!(path + tile.fastest > size) || !tile.has_triangles || !overlap(tile.box, of_path)) continue;
    found.is_fast = true;
    find_hits(s, tile, solid, found);
  }
  if (found.hits.empty()) return;
  std::sort(found.hits.begin(), found.hits.end(), [](const Hit& a, const Hit& b) { return a.triangle < b.triangle; });
  float first = 2;
  std::vector<Contact> all;
  for (const Hit& hit : found.hits) all.push_back(contact_of(s, hit, solid, number));
  for (std::size_t i = 0; i < all.size(); ++i)
    if (meets(all[i])) first = min(first, found.hits[i].time);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (found.hits[i].time <= first + same_time && meets(all[i])) found.contacts.push_back(all[i]);
}

void SweptContacts::detect(const Substep& s, const SurfaceTiles& surfaces, const std::vector<MovingCollider>& solids,
                           FunctionRef<bool(const Contact&)> meets, std::vector<Contact>& contacts) {
  found_.resize(solids.size());
  s.context.executor.parallel_for("bodies: fast solids", static_cast<int>(solids.size()),
                                  [&](int i) { detect_solid(s, surfaces, solids[at(i)], i, meets); });
  has_fast_ = std::any_of(found_.begin(), found_.end(), [](const Found& f) { return f.is_fast; });
  if (std::all_of(found_.begin(), found_.end(), [](const Found& f) { return f.contacts.empty(); })) return;
  std::erase_if(contacts,
                [&](const Contact& c) { return c.weight[1] != 0 && !found_[at(c.collider)].contacts.empty(); });
  for (const Found& found : found_) contacts.insert(contacts.end(), found.contacts.begin(), found.contacts.end());
}

Contact SweptContacts::contact_of(const Substep& s, const Hit& hit, const MovingCollider& solid, int number) {
  const CompiledObject& object = s.model.objects[at(hit.object)];
  const std::array<int, 3>& corners = hit.triangle;
  Contact c;
  c.point = {corners[0], corners[1], corners[2], corners[0]};
  c.weight = {hit.weights.x, hit.weights.y, hit.weights.z, 0};
  c.normal = hit.normal;
  const PairMaterial material = material_of(object, solid);
  c.thickness = material.thickness;
  c.collider = number;
  c.static_friction = material.static_friction;
  c.kinetic_friction = material.kinetic_friction;
  c.restitution = material.restitution;
  const Vec3f centre = centre_of(solid, solid.after), moved = centre - centre_of(solid, solid.before);
  c.surface_motion = moved;
  c.gap = dot(c.normal, relative(c, s.state.positions.data()) - centre) - reach_along(solid, c.normal) -
          thickness_of(object, solid);
  complete_contact(c, s.state.positions.data(), s.state.remainders.data());
  c.approach = dot(c.normal, relative(c, s.work.displacements.data()) - moved) / s.h;
  add_slide(solid, c);
  return c;
}

}  // namespace pliant
