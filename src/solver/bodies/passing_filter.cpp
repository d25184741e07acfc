#include "solver/bodies/passing_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/convex_distance.h"
#include "math/vector.h"
#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

using namespace bodies;

/// The gap that is kept, as a share of the cloth's thickness.
constexpr float share_of_thickness = 0.1f;
/// A projected contact may lack this share of its gap, or the rounding of positions: this share of them.
constexpr double share_left = 0.02, rounding = 5e-7;
/// Overlaps up to this share of the thickness come from rounding and from contacts that yield. They may not grow.
constexpr double shallow = 0.25;
/// Beyond this share of the radius of the ball inside a solid, a triangle could pass it within a substep.
constexpr float share_of_size = 0.5f;
/// Pairs are found for the motion of about so many substeps, and for this share of a solid's radius.
constexpr float substeps_of_pairs = 8, share_of_radius = 0.1f;

float inner_radius(const ConvexShape& shape) {
  switch (shape.kind) {
    case ConvexShape::Kind::point:
    case ConvexShape::Kind::segment:
      return shape.radius;
    case ConvexShape::Kind::cylinder:
      return min(shape.core_radius, shape.half_length) + shape.radius;
    case ConvexShape::Kind::cone:
      return 0.4f * min(shape.core_radius, shape.half_length) + shape.radius;
    case ConvexShape::Kind::polyhedron:
      break;
  }
  float least = 1e30f;
  const Polyhedron& p = *shape.polyhedron;
  for (int f = 0; f < p.faces(); ++f) {
    const Vec3f corner = p.corners[at(p.face_corners[at(p.first_of_face[at(f)])])];
    least = min(least, dot(p.normals[at(f)], corner - p.centre));
  }
  return least + shape.radius;
}

float outer_radius(const ConvexShape& shape) {
  const float r = shape.core_radius, h = shape.half_length;
  if (shape.kind != ConvexShape::Kind::polyhedron) return std::sqrt(r * r + h * h) + shape.radius;
  float most = 0;
  for (const Vec3f& corner : shape.polyhedron->corners) most = max(most, length_squared(corner));
  return std::sqrt(most) + shape.radius;
}

float gap_of(const Substep& s, int object) { return share_of_thickness * s.model.objects[at(object)].thickness; }

/// A triangle, or a line whose last vertex is repeated.
struct Element {
  Vec3d corner[3];
};

Element at_start(const Substep& s, const std::array<int, 3>& element) {
  Element out;
  for (std::size_t i = 0; i < 3; ++i) out.corner[i] = convert<double>(xyz(s.state.positions[at(element[i])]));
  return out;
}

/// With positions rounded as the update will round them.
Element at_end(const Substep& s, const std::array<int, 3>& element) {
  Element out;
  for (std::size_t i = 0; i < 3; ++i)
    out.corner[i] = convert<double>(xyz(s.state.positions[at(element[i])]) + xyz(s.work.displacements[at(element[i])]));
  return out;
}

/// The farthest that a solid reaches along a direction in the world [m].
double reach_along(const ConvexShape& shape, const Posed& pose, const Vec3d& direction) {
  const Vec3d local = rotate(conjugate(pose.rotation), direction);
  return dot(direction, pose.position) + dot(local, support(shape, local)) + static_cast<double>(shape.radius);
}

double nearest_along(const Element& e, const Vec3d& direction) {
  return std::min(dot(direction, e.corner[0]), std::min(dot(direction, e.corner[1]), dot(direction, e.corner[2])));
}

/// Their distance, with the normal from the solid to the triangle in the world.
ConvexDistance distance_of(const ConvexShape& shape, const Posed& pose, const Element& e, bool is_line,
                           Polyhedron& corners) {
  const Vec3d middle = (e.corner[0] + e.corner[1] + e.corner[2]) * (1. / 3);
  corners.corners.resize(is_line ? 2 : 3);
  for (std::size_t i = 0; i < corners.corners.size(); ++i)
    corners.corners[i] = convert<float>(to_local(pose, e.corner[i]) - to_local(pose, middle));
  const ConvexShape triangle{ConvexShape::Kind::polyhedron, 0, 0, 0, &corners};
  ConvexDistance out = convex_distance(shape, triangle, {to_local(pose, middle), Quatd{0, 0, 0, 1}});
  out.normal = rotate(pose.rotation, out.normal);
  return out;
}

}  // namespace

/// How a solid moves in a substep.
struct PassingFilter::Motion {
  Posed before, after;
  Vec3f displacement{};
  float turned = 0;  ///< largest displacement of a point of the solid by its rotation [m]

  Motion(const MovingCollider& at, float radius)
      : before(convert<double>(at.before)),
        after(convert<double>(at.after)),
        displacement(at.after.position - at.before.position) {
    const Quatf turn = multiply(at.after.rotation, conjugate(at.before.rotation));
    turned = 2.1f * length(Vec3f{turn.x, turn.y, turn.z}) * radius;
  }
};

PassingFilter::PassingFilter(const std::vector<ConvexShape>& shapes) {
  for (const ConvexShape& shape : shapes) {
    Solid& solid = solids_.emplace_back();
    solid.shape = shape;
    solid.inner = inner_radius(shape);
    solid.outer = outer_radius(shape);
  }
}

void PassingFilter::begin_frame() {
  for (Solid& solid : solids_) {
    solid.pairs.clear();
    solid.reach = -1;
  }
}

void PassingFilter::find_pairs(const Substep& s, const SurfaceTiles& surfaces, const MovingCollider& at_solid, int number,
                               const FunctionRef<bool(const Contact&)>& meets, Solid& solid) {
  std::vector<Pair> kept;
  kept.swap(solid.pairs);
  solid.reach = substeps_of_pairs * solid.next + share_of_radius * solid.outer;
  solid.spent = 0;
  const float extent = solid.outer + solid.reach;
  for (const int t : surfaces.tiles_near(number)) {
    const SurfaceTile& tile = surfaces.tiles()[at(t)];
    const float within = extent + gap_of(s, tile.object);
    const Vec3f by{within, within, within};
    const BoxBounds box{at_solid.before.position - by, at_solid.before.position + by};
    Contact contact;
    contact.collider = number;
    const auto may_touch = [&](const std::array<int, 3>& e) {
      contact.point = {e[0], e[1], e[2], e[2]};
      return meets(contact);
    };
    const auto is_near = [&](const std::array<int, 3>& e) {
      const Vec3f a = xyz(s.state.positions[at(e[0])]), b = xyz(s.state.positions[at(e[1])]),
                  c = xyz(s.state.positions[at(e[2])]);
      return overlap(box, {min(a, min(b, c)), max(a, max(b, c))});
    };
    solid.points.clear();
    tile.cells.query(box.grown(tile.longest), solid.points);
    for (const std::int32_t point : solid.points)
      for (int k = tile.first_element[at(point - tile.first)]; k < tile.first_element[at(point - tile.first) + 1]; ++k)
        if (is_near(tile.elements[at(k)]) && may_touch(tile.elements[at(k)]))
          solid.pairs.push_back({tile.elements[at(k)], tile.object});
  }
  // A direction that separates most pairs.
  for (Pair& pair : solid.pairs) {
    const Element e = at_start(s, pair.element);
    const Vec3d away = to_local(convert<double>(at_solid.before), (e.corner[0] + e.corner[1] + e.corner[2]) * (1. / 3));
    pair.normal = convert<float>(unit_or(away, Vec3d{0, 1, 0}));
  }
  // Bounds of pairs that are still near.
  const auto in_order = [](const Pair& a, const Pair& b) { return a.element < b.element; };
  std::sort(solid.pairs.begin(), solid.pairs.end(), in_order);
  auto old = kept.begin();
  for (Pair& pair : solid.pairs) {
    while (old != kept.end() && in_order(*old, pair)) ++old;
    if (old != kept.end() && old->element == pair.element) pair = *old;
  }
}

void PassingFilter::add_contacts(const Substep& s, int number, const Pair& pair, const Vec3d& normal, double least,
                                 std::vector<Contact>& found) {
  const Element start = at_start(s, pair.element), end = at_end(s, pair.element);
  for (std::size_t i = 0; i < 3; ++i) {
    const int vertex = pair.element[i];
    if ((i > 0 && vertex == pair.element[i - 1]) || !(dot(normal, end.corner[i]) < least)) continue;
    Contact& c = found.emplace_back();
    c.point = {vertex, vertex, vertex, vertex};
    c.weight = {1, 0, 0, 0};
    c.normal = convert<float>(normal);
    c.gap = static_cast<float>(dot(normal, start.corner[i]) - least);
    c.collider = number;
    complete_contact(c, s.state.positions.data(), s.state.remainders.data());
  }
}

void PassingFilter::check(const Substep& s, const Motion& motion, int number, Solid& solid, Pair& pair) {
  float squared = 0;
  for (const int vertex : pair.element)
    squared = max(squared, length_squared(xyz(s.work.displacements[at(vertex)]) - motion.displacement));
  const float moved = std::sqrt(squared) * (1 + 1e-5f) + motion.turned + 3e-7f, kept = gap_of(s, pair.object);
  pair.next = pair.bound - moved;
  pair.overlaps = false;
  if (pair.next > kept) return;
  const bool is_slow = moved < share_of_size * solid.inner;
  const Element end = at_end(s, pair.element);
  const auto gap_along = [&](const Vec3d& n) { return nearest_along(end, n) - reach_along(solid.shape, motion.after, n); };
  if (is_slow && pair.normal != Vec3f{}) {
    pair.next = static_cast<float>(gap_along(rotate(motion.after.rotation, convert<double>(pair.normal)))) - 1e-7f;
    if (pair.next > kept) return;
  }
  const bool is_line = pair.element[1] == pair.element[2];
  const auto keep = [&](const ConvexDistance& d, const Posed& pose) {
    pair.normal = convert<float>(rotate(conjugate(pose.rotation), d.normal));
  };
  const ConvexDistance before = distance_of(solid.shape, motion.before, at_start(s, pair.element), is_line, solid.corners);
  keep(before, motion.before);
  pair.next = 0;
  const auto thickness = static_cast<double>(s.model.objects[at(pair.object)].thickness);
  pair.overlaps = true;  // if not found otherwise
  if (before.separation < -shallow * thickness) return;
  const double rounded = rounding * (1 + largest(motion.after.position));
  const double least = std::min(std::max(static_cast<double>(kept), 2 * rounded), std::max(before.separation, 2 * rounded));
  const double wanted = before.separation < 0 ? before.separation : least;
  const double needed = wanted - std::max(share_left * wanted, rounded);
  const double gap = gap_along(before.normal);
  if (gap >= needed) {
    pair.overlaps = false;
    pair.next = static_cast<float>(gap) - 1e-7f;
    return;
  }
  if (is_slow) {
    const ConvexDistance after = distance_of(solid.shape, motion.after, end, is_line, solid.corners);
    if (after.separation >= needed) {
      keep(after, motion.after);
      pair.overlaps = false;
      pair.next = static_cast<float>(after.separation) - 1e-7f;
      return;
    }
  }
  add_contacts(s, number, pair, before.normal, reach_along(solid.shape, motion.after, before.normal) + wanted, solid.found);
}

void PassingFilter::find_of(const Substep& s, const SurfaceTiles& surfaces, const MovingCollider& at_solid, int number,
                            const Moved& moved, const FunctionRef<bool(const Contact&)>& meets) {
  Solid& solid = solids_[at(number)];
  solid.found.clear();
  if (surfaces.tiles_near(number).empty()) {
    solid.pairs.clear();
    solid.reach = -1;
    return;
  }
  const auto has_moved = [&](const Pair& pair) {
    return std::any_of(pair.element.begin(), pair.element.end(), [&](int v) { return (*moved.vertices)[at(v)] != 0; });
  };
  const bool is_all = moved.solids == nullptr || (*moved.solids)[at(number)] != 0;
  if (!is_all && std::none_of(solid.pairs.begin(), solid.pairs.end(), has_moved)) return;
  const Motion motion(at_solid, solid.outer);
  float fastest = moved.farthest;
  for (const int t : surfaces.tiles_near(number)) fastest = max(fastest, surfaces.tiles()[at(t)].fastest);
  solid.next = fastest + length(motion.displacement) + motion.turned;
  const bool is_new = !(solid.spent + solid.next <= solid.reach);
  if (is_new) find_pairs(s, surfaces, at_solid, number, meets, solid);
  for (Pair& pair : solid.pairs)
    if (is_all || is_new || has_moved(pair)) check(s, motion, number, solid, pair);
}

void PassingFilter::find(const Substep& s, const SurfaceTiles& surfaces, const std::vector<MovingCollider>& solids,
                         const Moved& moved, FunctionRef<bool(const Contact&)> meets, std::vector<Contact>& found) {
  s.context.executor.parallel_for(nullptr, static_cast<int>(solids.size()),
                                  [&](int i) { find_of(s, surfaces, solids[at(i)], i, moved, meets); });
  for (const Solid& solid : solids_) found.insert(found.end(), solid.found.begin(), solid.found.end());
}

void PassingFilter::end_substep(bool is_final) {
  for (Solid& solid : solids_) {
    solid.spent += solid.next;
    if (!is_final) solid.reach = -1;
    for (Pair& pair : solid.pairs) pair.bound = is_final ? pair.next : 0;
  }
}

std::vector<PassingFilter::Overlap> PassingFilter::overlaps() const {
  std::vector<Overlap> out;
  for (std::size_t i = 0; i < solids_.size(); ++i)
    for (const Pair& pair : solids_[i].pairs)
      if (pair.overlaps) out.push_back({pair.object, pair.element[0], static_cast<int>(i)});
  return out;
}

}  // namespace pliant
