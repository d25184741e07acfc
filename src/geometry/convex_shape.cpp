#include "geometry/convex_shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "math/vector.h"

namespace pliant {

namespace {

constexpr std::size_t corners_of_disc = 8;
/// A round solid lies on what is tilted by less against the surface [sine].
constexpr double flat = 0.02;

/// The farthest point of a disc in the plane of x and z.
Vec3d on_circle(double radius, const Vec3d& direction) {
  const double across = std::sqrt(direction.x * direction.x + direction.z * direction.z);
  if (!(across > 0)) return {radius, 0, 0};
  return {radius * direction.x / across, 0, radius * direction.z / across};
}

Vec3d farthest_corner(const Polyhedron& p, const Vec3d& direction) {
  const Vec3f* best = p.corners.data();
  double most = dot(direction, convert<double>(*best));
  for (const Vec3f& corner : p.corners) {
    const double reach = dot(direction, convert<double>(corner));
    const bool is_farther = reach > most;  // no branch: which corner is the farthest cannot be predicted
    most = is_farther ? reach : most;
    best = is_farther ? &corner : best;
  }
  return convert<double>(*best);
}

/// A regular polygon in place of a disc at the height y; it faces up or down.
Feature disc(double radius, double y, bool up) {
  constexpr double c = 0.70710678118654752;  // of an eighth of a turn
  constexpr std::array<std::array<double, 2>, corners_of_disc> around{
      {{1, 0}, {c, -c}, {0, -1}, {-c, -c}, {-1, 0}, {-c, c}, {0, 1}, {c, c}}};
  Feature out;
  out.count = static_cast<int>(corners_of_disc);
  for (std::size_t i = 0; i < corners_of_disc; ++i) {
    const auto& [x, z] = around[up ? i : corners_of_disc - 1 - i];
    out.points[i] = {radius * x, y, radius * z};
  }
  out.normal = {0, up ? 1. : -1., 0};
  return out;
}

Feature points_of(std::initializer_list<Vec3d> points) {
  Feature out;
  for (const Vec3d& p : points) out.points[static_cast<std::size_t>(out.count++)] = p;
  return out;
}

/// The face that is flattest in a direction, if all of it is near; else the farthest edge that is, or the farthest
/// corner.
Feature feature_of(const Polyhedron& p, const Vec3d& direction, double slack) {
  const Vec3d top = farthest_corner(p, direction);
  const double least = dot(direction, top) - slack;
  const auto is_near = [&](int corner) { return dot(direction, convert<double>(p.corners[corner])) >= least; };
  int best = 0;
  for (int f = 1; f < p.faces(); ++f)
    if (dot(direction, convert<double>(p.normals[f])) > dot(direction, convert<double>(p.normals[best]))) best = f;
  const auto first = p.face_corners.begin() + p.first_of_face[best], last = first + p.corners_of(best);
  if (std::all_of(first, last, is_near)) return face_of(p, best);
  const PolyhedronEdge* farthest =
      nullptr;  // of those near, else a box that tips about an edge would lie on another one
  double reached = 0;
  for (const PolyhedronEdge& edge : p.edges) {
    if (!is_near(edge.a) || !is_near(edge.b)) continue;
    const double far = dot(direction, convert<double>(p.corners[edge.a]) + convert<double>(p.corners[edge.b]));
    if (farthest != nullptr && !(far > reached)) continue;
    farthest = &edge;
    reached = far;
  }
  if (farthest == nullptr) return points_of({top});
  return points_of({convert<double>(p.corners[farthest->a]), convert<double>(p.corners[farthest->b])});
}

/// Of a solid of revolution with a segment as its outline: a disc below, one above if `has_top`, and a side.
Feature feature_of_round(const ConvexShape& shape, const Vec3d& direction, double slack) {
  const double r = shape.core_radius, h = shape.half_length, top_radius = shape.kind == ConvexShape::Kind::cone ? 0 : r;
  const double across = std::sqrt(direction.x * direction.x + direction.z * direction.z);
  const double tilt = 2 * r * across;  // the height of a disc in the direction
  const Vec3d side = on_circle(1, direction), below = side * r - Vec3d{0, h, 0},
              above = side * top_radius + Vec3d{0, h, 0};
  const bool has_disc = tilt <= slack && (direction.y < 0 || top_radius > 0),
             has_side = std::fabs(dot(direction, above - below)) <= slack;
  // Of a needle or a coin the slack exceeds the thickness: then the longer of both is what it lies on, unless it lies
  // on one of them already.
  const double of_side = length_squared(above - below), along = dot(direction, above - below);
  const bool lies_on_side = along * along <= flat * flat * of_side, lies_on_disc = across <= flat;
  const bool prefers_side = lies_on_side || (!lies_on_disc && of_side > 4 * r * r);
  if (has_side && (!has_disc || prefers_side)) return points_of({below, above});
  if (has_disc) return disc(r, direction.y < 0 ? -h : h, direction.y >= 0);
  return points_of({support(shape, direction)});
}

}  // namespace

Feature face_of(const Polyhedron& p, int face) {
  const int first = p.first_of_face[static_cast<std::size_t>(face)], all = p.corners_of(face);
  Feature out;
  out.count = std::min(all, Feature::most);
  for (int i = 0; i < out.count; ++i) {
    const int place = first + i * all / out.count, corner = p.face_corners[static_cast<std::size_t>(place)];
    out.points[static_cast<std::size_t>(i)] = convert<double>(p.corners[static_cast<std::size_t>(corner)]);
  }
  out.normal = convert<double>(p.normals[static_cast<std::size_t>(face)]);
  return out;
}

Vec3d support(const ConvexShape& shape, const Vec3d& direction) {
  const double end = direction.y < 0 ? -shape.half_length : shape.half_length;
  switch (shape.kind) {
    case ConvexShape::Kind::point:
      return {};
    case ConvexShape::Kind::segment:
      return {0, end, 0};
    case ConvexShape::Kind::cylinder:
      return on_circle(shape.core_radius, direction) + Vec3d{0, end, 0};
    case ConvexShape::Kind::cone: {
      const Vec3d base = on_circle(shape.core_radius, direction) - Vec3d{0, shape.half_length, 0};
      const Vec3d apex{0, shape.half_length, 0};
      return dot(direction, apex - base) >= 0 ? apex : base;
    }
    case ConvexShape::Kind::polyhedron:
      return farthest_corner(*shape.polyhedron, direction);
  }
  return {};
}

Feature feature_towards(const ConvexShape& shape, const Vec3d& direction, double slack) {
  switch (shape.kind) {
    case ConvexShape::Kind::point:
      return points_of({Vec3d{}});
    case ConvexShape::Kind::segment:
      if (2 * shape.half_length * std::fabs(direction.y) > slack) return points_of({support(shape, direction)});
      return points_of({Vec3d{0, -shape.half_length, 0}, Vec3d{0, shape.half_length, 0}});
    case ConvexShape::Kind::polyhedron:
      return feature_of(*shape.polyhedron, direction, slack);
    default:
      return feature_of_round(shape, direction, slack);
  }
}

}  // namespace pliant
