#include "collision/bodies/triangle_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "collision/bodies/triangle_nearest.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// A direction this close to the triangle's normal is that normal [cosine]: 0.08 degrees.
constexpr double straight = 1 - 1e-6;
/// Flat parts that face each other less than this serve no clipping [cosine].
constexpr double facing = 0.9;
/// The deepest place is a point of contact where all others are higher by this share of the solid's size.
constexpr double higher = 0.001;
/// Flat parts of a solid may differ in height by shares of its size between these.
constexpr double least_slack = 0.01, most_slack = 0.1;

constexpr int first_side = 64;  ///< sides of the triangle; edges of the solid's flat part have smaller numbers
constexpr std::uint32_t triangle_bit = 0x80000000u, is_nearest = 0x20000000u, is_deepest = 0x10000000u;

/// What makes a point of a triangle: the same number while the same corners and edges do.
std::uint32_t feature_of(int triangle, std::uint32_t what) {
  return triangle_bit | ((static_cast<std::uint32_t>(triangle) * 2654435761u) ^ what);
}

/// One triangle and one direction of contact.
struct Facing {
  const SolidInMesh& solid;
  const BodyMesh& mesh;
  int triangle;
  double reach;  ///< between the triangle and the solid's core [m]
  Vec3d normal;  ///< from the triangle to the solid
  bool is_flipped;

  const MeshFace& face() const { return mesh.face(triangle); }

  /// Points on sides that are not convex are inside the area of contact, because the solid touches the triangle beyond
  /// too.
  bool is_convex(int side) const { return face().sides[static_cast<std::size_t>(side)].is_convex(is_flipped); }

  Feature flat_part() const {
    const double slack = std::clamp(reach - solid.radius(), least_slack * solid.size(), most_slack * solid.size());
    return solid.feature(-normal, std::max(slack, solid.turning()));
  }

  void add(std::vector<TrianglePoint>& points, const TouchPoint& point) const {
    TrianglePoint out{triangle, normal, point, {}};
    out.point.on_a += normal * mesh.thickness();
    out.point.on_b -= normal * solid.radius();
    out.point.separation -= mesh.thickness() + solid.radius();
    points.push_back(out);
  }

  /// Adds the deepest place of the core, which its flattest part need not hold.
  void add_deepest(std::vector<TrianglePoint>& points, std::size_t first, double nearest) const {
    const Vec3d place = solid.support(-normal);
    const double separation = dot(normal, place - face().corners[0]);
    if (separation < nearest) return;
    double deepest = reach;
    for (std::size_t i = first; i < points.size(); ++i)
      deepest = std::min(deepest, points[i].point.separation + mesh.thickness() + solid.radius());
    if (separation < deepest - higher * solid.size())
      add(points, {place - normal * separation, place, separation, is_deepest});
  }
};

// ------------------------------------------------------------------------------------------------ above the triangle

/// A corner of the solid's flat part as cut off by the triangle's sides, and the edges and sides that meet there.
struct Corner {
  Vec3d place{};
  int before = 0, after = 0;
};
struct Corners {
  std::array<Corner, Feature::most + 4> at{};
  std::size_t count = 0;
};

Corners corners_of(const Feature& part) {
  Corners out;
  for (int i = 0; i < part.count; ++i)
    out.at[out.count++] = {part.points[static_cast<std::size_t>(i)], (i + part.count - 1) % part.count, i};
  return out;
}

/// Keeps what is not beyond a side (Sutherland and Hodgman 1974). The second of a segment's two equal edges gives no
/// point of its own.
template <class Beyond>
Corners clipped(const Corners& corners, const Beyond& beyond, int side, bool is_segment) {
  Corners out;
  for (std::size_t i = 0; i < corners.count; ++i) {
    const Corner &from = corners.at[i], &to = corners.at[(i + 1) % corners.count];
    const double start = beyond(from.place), end = beyond(to.place);
    if (start <= 0 && out.count < out.at.size()) out.at[out.count++] = from;
    const bool crosses = (start < 0 && end > 0) || (start > 0 && end < 0);
    if (!crosses || (is_segment && i == 1) || out.count == out.at.size()) continue;
    const Vec3d place = from.place + (to.place - from.place) * (start / (start - end));
    out.at[out.count++] = start < 0 ? Corner{place, from.after, side} : Corner{place, side, from.after};
  }
  return out;
}

Corners over_triangle(const MeshFace& face, const Feature& part, bool is_flipped) {
  Corners corners = corners_of(part);
  for (std::size_t k = 0; k < 3 && corners.count > 0; ++k) {
    // A corner of the solid exactly above an inner side must not fall between the two triangles.
    const double slack = face.sides[k].is_inner ? MeshSide::tolerance : 0;
    const auto beyond = [&](const Vec3d& point) { return face.beyond(k, point, is_flipped) - slack; };
    corners = clipped(corners, beyond, first_side + static_cast<int>(k), part.count == 2);
  }
  return corners;
}

/// True if a place is above a triangle along the triangle's own normal.
bool is_above(const Facing& at, const Vec3d& place) {
  for (std::size_t k = 0; k < 3; ++k)
    if (at.face().beyond(k, place, at.is_flipped) > (at.face().sides[k].is_inner ? MeshSide::tolerance : 0))
      return false;
  return true;
}

/// The points of the solid's flat part that are above the triangle along the triangle's own normal.
void add_points_above(const Facing& at, const TriangleNearest& nearest, std::vector<TrianglePoint>& points) {
  const MeshFace& face = at.face();
  const Feature part = at.flat_part();
  const std::size_t first = points.size();
  // Nothing that is over the triangle is nearer than the nearest place; what is has been cut off by a valley's plane
  // alone.
  const double least = nearest.separation > 0 ? nearest.separation - MeshSide::tolerance : -1e300;
  const Corners corners = over_triangle(face, part, at.is_flipped);
  for (std::size_t i = 0; i < corners.count; ++i) {
    const Corner& corner = corners.at[i];
    const int sides[2] = {corner.before - first_side, corner.after - first_side};
    const bool is_own = sides[0] < 0 && sides[1] < 0;
    if (!is_own && !(sides[0] >= 0 && at.is_convex(sides[0])) && !(sides[1] >= 0 && at.is_convex(sides[1]))) continue;
    const double separation = dot(at.normal, corner.place - face.corners[0]);
    if (separation > at.reach || separation < least) continue;
    const std::uint32_t what =
        static_cast<std::uint32_t>(corner.before) << 8 | static_cast<std::uint32_t>(corner.after);
    at.add(points, {corner.place - at.normal * separation, corner.place, separation,
                    is_own ? what : feature_of(at.triangle, what)});
  }
  if (is_above(at, at.solid.support(-at.normal))) at.add_deepest(points, first, least);
}

// ------------------------------------------------------------------------------------------------ edges and corners

/// The edge or corner of a triangle that is farthest in a direction.
struct Extreme {
  bool is_side = false;
  int index = 0;
};

Extreme farthest_in(const MeshFace& face, const Vec3d& direction) {
  std::array<double, 3> height{};
  for (std::size_t k = 0; k < 3; ++k) height[k] = dot(direction, face.corners[k]);
  const auto top = static_cast<std::size_t>(std::max_element(height.begin(), height.end()) - height.begin());
  for (const std::size_t k : {top, (top + 2) % 3}) {
    const double rise = height[(k + 1) % 3] - height[k],
                 tolerance = 1e-3 * length(face.corners[(k + 1) % 3] - face.corners[k]);
    if (std::fabs(rise) <= tolerance) return {true, static_cast<int>(k)};
  }
  return {false, static_cast<int>(top)};
}

bool is_in_normal_cone(const BodyMesh& mesh, int triangle, const Vec3d& direction) {
  const Extreme at = farthest_in(mesh.face(triangle), direction);
  return at.is_side ? mesh.is_normal_at_side(triangle, at.index, direction)
                    : mesh.is_normal_at_corner(triangle, at.index, direction);
}

/// True if no other triangle is nearer to what is in a direction from a triangle.
bool is_own_direction(const BodyMesh& mesh, int triangle, const Vec3d& direction) {
  const double along = dot(direction, mesh.face(triangle).normal);
  return !(mesh.is_terrain() && along <= 0) &&
         (std::fabs(along) >= straight || is_in_normal_cone(mesh, triangle, direction));
}

Feature triangle_part(const MeshFace& face, const Vec3d& normal) {
  const auto& t = face.corners;
  Feature out;
  const double turned = dot(face.normal, normal);
  if (std::fabs(turned) > facing) {
    out.count = 3;
    out.points = {t[0], t[1], t[2]};
    if (turned < 0) std::swap(out.points[1], out.points[2]);
    out.normal = turned < 0 ? -face.normal : face.normal;
    return out;
  }
  const Extreme at = farthest_in(face, normal);
  const auto k = static_cast<std::size_t>(at.index);
  out.count = at.is_side ? 2 : 1;
  out.points[0] = t[k];
  if (at.is_side) out.points[1] = t[(k + 1) % 3];
  return out;
}

/// The points at which a flat part of the solid lies on a triangle's edge or corner, or on several of them.
void add_points_below(const Facing& at, const TriangleNearest& nearest, std::vector<TrianglePoint>& points) {
  const Feature part = at.flat_part(), below = triangle_part(at.face(), at.normal);
  double deepest = 1e300;
  if (part.count > 2 && -dot(part.normal, at.normal) > facing && below.count > 1)
    for (TouchPoint point : points_over(part, below, at.normal, true, at.reach)) {
      point.feature = feature_of(at.triangle, point.feature);
      deepest = std::min(deepest, point.separation);
      at.add(points, point);
    }
  if (deepest <= nearest.separation + 1e-3 * at.solid.size()) return;
  at.add(points, {nearest.on_triangle, nearest.on_solid, nearest.separation, feature_of(at.triangle, is_nearest)});
}

}  // namespace

void touch_triangle(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, double reach,
                    std::vector<TrianglePoint>& points) {
  const MeshFace& face = mesh.face(triangle);
  if (!(length_squared(face.normal) > 0)) return;  // its edges are those of neighbours
  const double core_reach = reach + mesh.thickness() + solid.radius();
  touch_triangle(solid, mesh, triangle, reach, nearest_on(face, solid, core_reach, mesh.is_terrain()), points);
}

void touch_triangle(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, double reach,
                    const TriangleNearest& nearest, std::vector<TrianglePoint>& points) {
  if (!nearest.is_near) return;
  const MeshFace& face = mesh.face(triangle);
  const double core_reach = reach + mesh.thickness() + solid.radius();
  const double along = dot(nearest.normal, face.normal);
  const bool is_behind = mesh.is_terrain() && along <= 0, is_straight = std::fabs(along) >= straight;
  Facing at{solid, mesh, triangle, core_reach, nearest.normal, along < 0};
  if (!is_behind && !is_straight && is_in_normal_cone(mesh, triangle, nearest.normal))
    return add_points_below(at, nearest, points);
  at.normal = facing_normal(face, solid.centre(), mesh.is_terrain());
  if (is_straight && !is_behind) at.normal = along < 0 ? -face.normal : face.normal;
  at.is_flipped = dot(at.normal, face.normal) < 0;
  add_points_above(at, nearest, points);
}

bool has_direction(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, const Vec3d& normal) {
  const MeshFace& face = mesh.face(triangle);
  // Only its own normal holds what is near a smooth triangle, wherever it is nearest.
  const bool is_smooth = face.is_smooth[dot(face.normal, solid.centre() - face.corners[0]) < 0 ? 1 : 0];
  return is_smooth || is_own_direction(mesh, triangle, normal);
}

Vec3d direction_of_contact(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, const Vec3d& normal) {
  return is_own_direction(mesh, triangle, normal)
             ? normal
             : facing_normal(mesh.face(triangle), solid.centre(), mesh.is_terrain());
}

void touch_plane_of(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, const Vec3d& normal, double reach,
                    std::vector<TrianglePoint>& points) {
  const MeshFace& face = mesh.face(triangle);
  const Facing at{solid, mesh, triangle, reach + mesh.thickness() + solid.radius(), normal, false};
  const std::size_t first = points.size();
  const Feature part = at.flat_part();
  for (int i = 0; i < part.count; ++i) {
    const Vec3d& place = part.points[static_cast<std::size_t>(i)];
    const double separation = dot(normal, place - face.corners[0]);
    if (separation > at.reach) continue;
    at.add(points, {place - normal * separation, place, separation, static_cast<std::uint32_t>(i)});
  }
  at.add_deepest(points, first, -1e300);
}

void touch_beyond_valley(const SolidInMesh& solid, const BodyMesh& mesh, int triangle, double reach,
                         std::vector<TrianglePoint>& points) {
  const MeshFace& face = mesh.face(triangle);
  const Vec3d normal = facing_normal(face, solid.centre(), mesh.is_terrain()), lowest = solid.support(-normal);
  const bool is_flipped = dot(normal, face.normal) < 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (face.beyond(k, lowest, is_flipped) > 0 && face.sides[k].is_convex(is_flipped)) return;
  touch_plane_of(solid, mesh, triangle, normal, reach, points);
}

int least_overlapped(const SolidInMesh& solid, const BodyMesh& mesh, const std::vector<int>& triangles) {
  int best = -1;
  double least = 0;
  for (const int triangle : triangles) {
    const MeshFace& face = mesh.face(triangle);
    const bool is_flat = length_squared(face.normal) > 0;
    const double radii = solid.radius() + mesh.thickness();
    if (!is_flat || !nearest_on(face, solid, radii, mesh.is_terrain()).is_near) continue;
    // Only a triangle's own normal is looked at where it is smooth, though the solid may reach below its plane beside
    // it.
    if (!mesh.is_terrain() && !(exactly_nearest_on(face, solid, {}).separation <= radii)) continue;
    const Vec3d normal = facing_normal(face, solid.centre(), mesh.is_terrain());
    const double separation = dot(normal, solid.support(-normal) - face.corners[0]);
    if (best >= 0 && separation <= least) continue;
    best = triangle;
    least = separation;
  }
  return best;
}

}  // namespace pliant
