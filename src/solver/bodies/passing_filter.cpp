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

/// The gap that is kept, as a share of the cloth's thickness.
constexpr float gap_over_thickness = 0.1f;
/// A projected contact may lack this share of its gap, or the rounding of positions: this share of them.
constexpr double gap_tolerance = 0.02, rounding_share = 5e-7;
/// Overlaps up to this share of the thickness come from rounding and from contacts that yield. They may not grow.
constexpr double shallow = 0.25;
/// Beyond this share of the radius of the ball inside a solid, a triangle could pass it within a substep.
constexpr float motion_over_inner_radius = 0.5f;
/// Pairs are found for the motion of about so many substeps, and for this share of a solid's radius.
constexpr float substeps_of_pairs = 16, share_of_radius = 0.15f;
/// The same for which pairs are far.
constexpr float substeps_of_groups = 8, share_of_groups = 0.02f;
/// A bound of all motion that is smaller than this share of what far pairs allow is good enough.
constexpr float share_of_slack = 0.05f;
/// What is added to a motion for rounding: a share of it, and positions' [m].
constexpr float motion_rounding = 1 + 1e-5f, position_rounding = 3e-7f;

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

PassingFilter::Motion PassingFilter::motion_of(const MovingCollider& at, float radius) {
  const Quatf turn = multiply(at.after.rotation, conjugate(at.before.rotation));
  return {convert<double>(at.before), convert<double>(at.after), at.after.position - at.before.position,
          2.1f * length(Vec3f{turn.x, turn.y, turn.z}) * radius};
}

void PassingFilter::forget(Solid& solid) {
  solid.pairs.clear();
  solid.vertices.clear();
  solid.is_grouped = false;
  solid.reach = -1;
}

PassingFilter::PassingFilter(const std::vector<ConvexShape>& shapes) {
  for (const ConvexShape& shape : shapes) {
    Solid& solid = solids_.emplace_back();
    solid.shape = shape;
    solid.inner = inner_radius(shape);
    solid.outer = outer_radius(shape);
  }
}

void PassingFilter::begin_frame() {
  for (Solid& solid : solids_) forget(solid);
}

/// Takes the motion that far pairs have used from their bounds, so that all pairs are alike.
void PassingFilter::take_motion(Solid& solid) {
  if (!solid.is_grouped) return;
  auto close = solid.close.begin();
  for (int i = 0; i < static_cast<int>(solid.pairs.size()); ++i) {
    if (close != solid.close.end() && *close == i)
      ++close;
    else
      solid.pairs[at(i)].bound -= solid.used;
  }
  solid.is_grouped = false;
}

void PassingFilter::find_pairs(const Substep& s, const SurfaceTiles& surfaces, const MovingCollider& at_solid,
                               int number, const FunctionRef<bool(const Contact&)>& meets, Solid& solid) {
  take_motion(solid);
  std::vector<Pair> kept;
  kept.swap(solid.pairs);
  solid.reach = substeps_of_pairs * solid.next + share_of_radius * solid.outer;
  solid.spent = 0;
  const float extent = solid.outer + solid.reach;
  for (const int t : surfaces.tiles_near(number)) {
    const SurfaceTile& tile = surfaces.tiles()[at(t)];
    const float thickness = thickness_of(s.model.objects[at(tile.object)], at_solid),
                within = extent + gap_over_thickness * thickness;
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
    tile.near_points.cells().query(box.grown(tile.longest), solid.points);
    for (const std::int32_t point : solid.points)
      for (int k = tile.first_element[at(point - tile.first)]; k < tile.first_element[at(point - tile.first) + 1]; ++k)
        if (is_near(tile.elements[at(k)]) && may_touch(tile.elements[at(k)]))
          solid.pairs.push_back({tile.elements[at(k)], tile.object, thickness});
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
  solid.vertices.clear();
  for (const Pair& pair : solid.pairs)
    solid.vertices.insert(solid.vertices.end(), pair.element.begin(), pair.element.end());
  std::sort(solid.vertices.begin(), solid.vertices.end());
  solid.vertices.erase(std::unique(solid.vertices.begin(), solid.vertices.end()), solid.vertices.end());
}

/// Finds which pairs are far, so that a bound of all motion tells that none of them passes.
void PassingFilter::group_pairs(Solid& solid) {
  const float least = substeps_of_groups * solid.fastest + share_of_groups * solid.outer;
  solid.close.clear();
  solid.slack = 1e30f;
  solid.used = 0;
  for (int i = 0; i < static_cast<int>(solid.pairs.size()); ++i) {
    const float room = solid.pairs[at(i)].bound - gap_over_thickness * solid.pairs[at(i)].thickness;
    if (room > least)
      solid.slack = min(solid.slack, room);
    else
      solid.close.push_back(i);
  }
  solid.is_grouped = true;
}

/// True if no far pair can pass by the present motion, which is then used.
bool PassingFilter::far_pairs_stay_clear(const Substep& s, Solid& solid) {
  float moved = solid.next * motion_rounding + position_rounding;
  if (!(moved < share_of_slack * (solid.slack - solid.used))) {
    float squared = 0;
    for (const int vertex : solid.vertices)
      squared = max(squared, length_squared(xyz(s.work.displacements[at(vertex)]) - solid.motion.displacement));
    moved = std::sqrt(squared) * motion_rounding + solid.motion.turned + position_rounding;
  }
  solid.next_used = solid.used + moved;
  return solid.next_used < solid.slack;
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

void PassingFilter::check(const Substep& s, int number, Solid& solid, Pair& pair) {
  const Motion& motion = solid.motion;
  float squared = 0;
  for (const int vertex : pair.element)
    squared = max(squared, length_squared(xyz(s.work.displacements[at(vertex)]) - motion.displacement));
  const float moved = std::sqrt(squared) * motion_rounding + motion.turned + position_rounding,
              kept = gap_over_thickness * pair.thickness;
  solid.fastest = max(solid.fastest, moved);
  pair.next = pair.bound - moved;
  pair.overlaps = false;
  if (pair.next > kept) return;
  const bool is_slow = moved < motion_over_inner_radius * solid.inner;
  const Element end = at_end(s, pair.element);
  const auto gap_along = [&](const Vec3d& n) {
    return nearest_along(end, n) - reach_along(solid.shape, motion.after, n);
  };
  if (is_slow && pair.normal != Vec3f{}) {
    pair.next = static_cast<float>(gap_along(rotate(motion.after.rotation, convert<double>(pair.normal)))) - 1e-7f;
    if (pair.next > kept) return;
  }
  const bool is_line = pair.element[1] == pair.element[2];
  const auto keep = [&](const ConvexDistance& d, const Posed& pose) {
    pair.normal = convert<float>(rotate(conjugate(pose.rotation), d.normal));
  };
  const ConvexDistance before =
      distance_of(solid.shape, motion.before, at_start(s, pair.element), is_line, solid.corners);
  keep(before, motion.before);
  pair.next = 0;
  const auto thickness = static_cast<double>(pair.thickness);
  pair.overlaps = true;  // if not found otherwise
  if (before.separation < -shallow * thickness) return;
  const double rounded = rounding_share * (1 + largest(motion.after.position));
  const double least =
      std::min(std::max(static_cast<double>(kept), 2 * rounded), std::max(before.separation, 2 * rounded));
  const double wanted = before.separation < 0 ? before.separation : least;
  const double needed = wanted - std::max(gap_tolerance * wanted, rounded);
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
  add_contacts(s, number, pair, before.normal, reach_along(solid.shape, motion.after, before.normal) + wanted,
               solid.found);
}

/// Finds which pairs of a solid a find concerns.
void PassingFilter::begin_find(const SurfaceTiles& surfaces, const MovingCollider& at_solid, int number,
                               const Moved& moved, Solid& solid) {
  solid.found.clear();
  solid.is_concerned = solid.is_new = false;
  if (surfaces.tiles_near(number).empty()) return forget(solid);
  solid.is_all = moved.solids == nullptr || (*moved.solids)[at(number)] != 0;
  solid.is_concerned = solid.is_all || std::any_of(solid.vertices.begin(), solid.vertices.end(),
                                                   [&](int v) { return (*moved.vertices)[at(v)] != 0; });
  if (!solid.is_concerned) return;
  solid.motion = motion_of(at_solid, solid.outer);
  float fastest = moved.farthest;
  for (const int t : surfaces.tiles_near(number)) fastest = max(fastest, surfaces.tiles()[at(t)].fastest);
  solid.next = fastest + length(solid.motion.displacement) + solid.motion.turned;
  solid.is_new = !(solid.spent + solid.next <= solid.reach);
}

void PassingFilter::find_of(const Substep& s, const SurfaceTiles& surfaces, const MovingCollider& at_solid, int number,
                            const Moved& moved, const FunctionRef<bool(const Contact&)>& meets, Solid& solid) {
  if (!solid.is_concerned) return;
  if (solid.is_new) find_pairs(s, surfaces, at_solid, number, meets, solid);
  const auto has_moved = [&](const Pair& pair) {
    return std::any_of(pair.element.begin(), pair.element.end(), [&](int v) { return (*moved.vertices)[at(v)] != 0; });
  };
  const bool begins = moved.solids == nullptr;
  if (begins && !solid.is_new && !solid.is_grouped) group_pairs(solid);
  if (solid.is_grouped && far_pairs_stay_clear(s, solid)) {
    for (const int i : solid.close)
      if (solid.is_all || has_moved(solid.pairs[at(i)])) check(s, number, solid, solid.pairs[at(i)]);
    return;
  }
  const bool is_whole = solid.is_all || solid.is_new || solid.is_grouped;  // far pairs were not checked in this substep
  take_motion(solid);
  if (is_whole) solid.fastest = 0;
  for (Pair& pair : solid.pairs)
    if (is_whole || has_moved(pair)) check(s, number, solid, pair);
}

/// Sorts the particles of the tiles in which pairs are found.
void PassingFilter::sort_points(const Substep& s, SurfaceTiles& surfaces) {
  tiles_.clear();
  for (std::size_t i = 0; i < solids_.size(); ++i)
    if (solids_[i].is_new) {
      const std::vector<int>& near = surfaces.tiles_near(static_cast<int>(i));
      tiles_.insert(tiles_.end(), near.begin(), near.end());
    }
  std::sort(tiles_.begin(), tiles_.end());
  tiles_.erase(std::unique(tiles_.begin(), tiles_.end()), tiles_.end());
  s.context.executor.parallel_for(nullptr, static_cast<int>(tiles_.size()),
                                  [&](int i) { surfaces.sort_points(s, tiles_[at(i)]); });
}

void PassingFilter::find(const Substep& s, SurfaceTiles& surfaces, const std::vector<MovingCollider>& solids,
                         const Moved& moved, FunctionRef<bool(const Contact&)> meets, std::vector<Contact>& found) {
  const auto for_solids = [&](FunctionRef<void(int)> body) {
    s.context.executor.parallel_for(nullptr, static_cast<int>(solids.size()), body);
  };
  for_solids([&](int i) { begin_find(surfaces, solids[at(i)], i, moved, solids_[at(i)]); });
  sort_points(s, surfaces);
  for_solids([&](int i) { find_of(s, surfaces, solids[at(i)], i, moved, meets, solids_[at(i)]); });
  for (const Solid& solid : solids_) found.insert(found.end(), solid.found.begin(), solid.found.end());
}

void PassingFilter::end_substep(bool is_final) {
  for (Solid& solid : solids_) {
    solid.spent += solid.next;
    if (!is_final) {
      solid.reach = -1;
      solid.is_grouped = false;
      for (Pair& pair : solid.pairs) pair.bound = 0;
    } else if (solid.is_grouped) {
      solid.used = solid.next_used;
      for (const int i : solid.close) solid.pairs[at(i)].bound = solid.pairs[at(i)].next;
    } else {
      for (Pair& pair : solid.pairs) pair.bound = pair.next;
    }
  }
}

void PassingFilter::note_shift(float farthest) {
  for (Solid& solid : solids_) {
    take_motion(solid);
    solid.spent += 2 * farthest;
    for (Pair& pair : solid.pairs) pair.bound -= 2 * farthest;
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
