#include "collision/bodies/kept_side.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "collision/bodies/solid_in_mesh.h"
#include "geometry/convex_contact.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// Normals that agree less than this have changed sides: by more than 120 degrees since the last search.
constexpr double other_way = -0.5;
/// Normals of triangles that continue one another agree at least so much.
constexpr double same_way = 0.7;

/// A convex part in the frame of body a.
struct Placed {
  const ConvexShape& shape;
  Posed pose;

  /// How far it reaches along a unit vector from the origin of the frame.
  double reach(const Vec3d& direction) const {
    const Vec3d far = to_world(pose, support(shape, rotate(conjugate(pose.rotation), direction)));
    return dot(direction, far) + static_cast<double>(shape.radius);
  }
  double extent(const Vec3d& direction) const { return reach(direction) + reach(-direction); }
};

/// Two unit vectors perpendicular to a third and to one another.
std::pair<Vec3d, Vec3d> across(const Vec3d& normal) {
  const Vec3d axis = std::fabs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d first = unit_or(cross(normal, axis), axis);
  return {first, cross(normal, first)};
}

double area(const Placed& part, const Vec3d& normal) {
  const auto [first, second] = across(normal);
  return part.extent(first) * part.extent(second);
}

/// The surface of a half-space that contains a part, with its normal along y.
Posed surface(const Placed& part, const Vec3d& normal) {
  const Quatd half = normal.y > -0.9999 ? Quatd{normal.z, 0, -normal.x, 1 + normal.y} : Quatd{1, 0, 0, 0};
  return {normal * part.reach(normal), normalise(half)};
}

/// Contact points of a half-space with a part. Those on the half-space are on_a.
Touch touch_surface(const Posed& surface, const Placed& part, double margin, double turning) {
  const Posed pose{to_local(surface, part.pose.position),
                   normalise(multiply(conjugate(surface.rotation), part.pose.rotation))};
  Touch found = touch_half_space(part.shape, pose, margin, turning);
  found.normal = rotate(surface.rotation, found.normal);
  for (int i = 0; i < found.count; ++i) {
    TouchPoint& point = found.points[static_cast<std::size_t>(i)];
    point.on_a = to_world(surface, point.on_a);
    point.on_b = to_world(surface, point.on_b);
  }
  return found;
}

/// What contact a part had with a mesh, in the mesh's frame.
struct MeshContactBefore {
  Vec3d normal{}, place{}, centre{};  ///< of the contact, and of the part then
  double size = 0;

  MeshContactBefore(const BodyContact& contact, const BodyPart& b)
      : normal(rotate(conjugate(convert<double>(contact.turned)), convert<double>(contact.normal))),
        place(convert<double>(contact.anchor_a[0])) {
    const Posed pose{convert<double>(contact.position), convert<double>(contact.rotation)};
    const SolidInMesh solid(b.shape, compose(pose, b.pose), 0);
    centre = solid.centre();
    size = solid.size();
  }
  double height(const Vec3d& point) const { return dot(normal, point - place); }
};

/// True if a point is over a triangle along its normal, or beside it by no more than `margin` [m].
bool is_over(const MeshFace& face, const Vec3d& point, double margin) {
  for (std::size_t k = 0; k < 3; ++k)
    if (dot(face.sides[k].outward, point - face.corners[k]) > margin) return false;
  return true;
}

/// The first triangle that lies between two places.
MeshSideKept first_between(const BodyMesh& mesh, const Vec3d& from, const Vec3d& to) {
  const Vec3d low{std::min(from.x, to.x), std::min(from.y, to.y), std::min(from.z, to.z)},
      high{std::max(from.x, to.x), std::max(from.y, to.y), std::max(from.z, to.z)};
  std::vector<int> near;
  mesh.find(BoxBounds{convert<float>(low), convert<float>(high)}.grown(1e-5f), near);
  MeshSideKept found;
  double first = 2;
  for (const int triangle : near) {
    const MeshFace& face = mesh.face(triangle);
    const double before = dot(face.normal, from - face.corners[0]), after = dot(face.normal, to - face.corners[0]);
    if (before == 0 || before * after > 0) continue;
    const double share = before / (before - after);
    if (share >= first || !is_over(face, from + (to - from) * share, MeshSide::tolerance)) continue;
    first = share;
    found = {triangle, before > 0 ? face.normal : -face.normal};
  }
  return found;
}

/// The triangle over which a point lies that has slid on from one with that normal, at most `farthest` from its plane.
MeshSideKept beside(const BodyMesh& mesh, const Vec3d& point, const Vec3d& normal, double farthest) {
  std::vector<int> near;
  mesh.find(BoxBounds{convert<float>(point), convert<float>(point)}.grown(static_cast<float>(farthest)), near);
  MeshSideKept found;
  double least = farthest;
  for (const int triangle : near) {
    const MeshFace& face = mesh.face(triangle);
    const double along = dot(face.normal, normal), height = std::fabs(dot(face.normal, point - face.corners[0]));
    if (std::fabs(along) < same_way || height >= least || !is_over(face, point, MeshSide::tolerance)) continue;
    least = height;
    found = {triangle, along < 0 ? -face.normal : face.normal};
  }
  return found;
}

}  // namespace

bool has_changed_sides(const Touch& found, const Posed& a, std::span<const BodyContact> before) {
  if (found.count == 0 || before.size() != 1) return false;
  const bool overlap = std::any_of(found.points.begin(), found.points.begin() + found.count,
                                   [](const TouchPoint& point) { return point.separation < 0; });
  return overlap && dot(rotate(a.rotation, found.normal), convert<double>(before.front().normal)) < other_way;
}

Touch touch_along(const BodyPart& a, const BodyPart& b, const Posed& b_in_a, const Vec3d& normal, double margin,
                  double turning) {
  const Placed one{a.shape, a.pose}, other{b.shape, compose(b_in_a, b.pose)};
  if (area(one, normal) >= area(other, normal)) return touch_surface(surface(one, normal), other, margin, turning);
  Touch found = touch_surface(surface(other, -normal), one, margin, turning);
  found.normal = normal;
  for (int i = 0; i < found.count; ++i) {
    TouchPoint& point = found.points[static_cast<std::size_t>(i)];
    std::swap(point.on_a, point.on_b);
  }
  return found;
}

MeshSideKept side_kept(const BodyMesh& mesh, const BodyPart& b, const Posed& b_in_mesh, double farthest,
                       std::span<const BodyContact> before) {
  if (before.empty() || mesh.is_terrain()) return {};
  const Vec3d centre = SolidInMesh(b.shape, compose(b_in_mesh, b.pose), 0).centre();
  const MeshContactBefore first(before.front(), b);
  const double ahead = std::fabs(static_cast<double>(before.front().gap[0]));  // it was found that far away
  if (length(centre - first.centre) > farthest + 2 * ahead + 4 * first.size) return {};
  for (const BodyContact& contact : before) {
    const MeshContactBefore old(contact, b);
    const int triangle = contact.a.piece;
    if (triangle < 0 || triangle >= mesh.triangle_count()) continue;
    if (old.height(old.centre) > 0 || old.height(centre) > 0) continue;
    const MeshFace& face = mesh.face(triangle);
    if (is_over(face, centre, old.size))
      return {triangle, dot(face.normal, old.normal) < 0 ? -face.normal : face.normal};
    const MeshSideKept next = beside(mesh, centre, old.normal, old.size - old.height(centre));
    if (next.triangle >= 0) return next;
  }
  return first_between(mesh, first.centre, centre);
}

}  // namespace pliant
