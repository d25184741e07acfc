#include "collision/bodies/triangle_nearest.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/convex_distance.h"
#include "geometry/triangle.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// An axis must be better by this share of the solid's size to replace one of a preferred kind: the triangle's normal,
/// then those of the solid's faces, then those across edges.
constexpr double preference = 1e-3;
/// Overlap along the triangle's normal up to this share of the solid's size needs no search if the deepest point is
/// over it.
constexpr double shallow = 0.05;
/// What overlaps a triangle by less than this share of its depth below the plane is beside it.
constexpr double beside_share = 0.05;
/// Edges more parallel than this have no axis [sine].
constexpr double parallel = 1e-4;

Vec3d lowest_corner(const MeshFace& face, const Vec3d& direction) {
  const auto& t = face.corners;
  const double a = dot(direction, t[0]), b = dot(direction, t[1]), c = dot(direction, t[2]);
  return a <= b && a <= c ? t[0] : b <= c ? t[1] : t[2];
}

/// True if a point lies over a triangle along its normal, or beyond flat sides by a rounding; from sides at which the
/// surface ends or bends it must be so far [m].
bool is_over_triangle(const MeshFace& face, const Vec3d& point, double from_edges) {
  for (std::size_t k = 0; k < 3; ++k) {
    const MeshSide& side = face.sides[k];
    const bool is_flat = side.is_inner && std::fabs(side.fold) <= MeshSide::flat;
    const double most = is_flat ? MeshSide::tolerance : -from_edges;
    if (dot(side.outward, point - face.corners[k]) > most) return false;
  }
  return true;
}

/// The axis along the triangle's normal, on the side on which the solid's centre is.
TriangleNearest along_normal(const MeshFace& face, const SolidInMesh& solid, bool is_one_sided) {
  TriangleNearest out;
  out.normal = facing_normal(face, solid.centre(), is_one_sided);
  out.on_solid = solid.support(-out.normal);
  out.separation = dot(out.normal, out.on_solid - face.corners[0]);
  out.on_triangle = out.on_solid - out.normal * out.separation;
  return out;
}

/// A ball's core is a point.
TriangleNearest nearest_of_point(const MeshFace& face, const Vec3d& point) {
  const auto found = closest_on_triangle(point, face.corners[0], face.corners[1], face.corners[2]);
  const Vec3d away = point - found.point;
  TriangleNearest out;
  out.separation = length(away);
  out.normal = out.separation > 1e-9 ? away * (1 / out.separation) : face.normal;
  out.on_triangle = found.point;
  out.on_solid = point;
  return out;
}

/// Of cores that are apart, and of round ones.
TriangleNearest nearest_by_supports(const MeshFace& face, const SolidInMesh& solid, double reach,
                                    const Vec3d& displacement = {}) {
  Polyhedron triangle;
  for (const Vec3d& corner : face.corners) triangle.corners.push_back(convert<float>(corner));
  const Posed pose{solid.pose().position + displacement, solid.pose().rotation};
  ConvexShape core = solid.shape();
  core.radius = 0;
  const ConvexDistance found = convex_distance({ConvexShape::Kind::polyhedron, 0, 0, 0, &triangle}, core, pose, reach);
  return {true, found.normal, found.separation, found.on_a, found.on_b};
}

// ------------------------------------------------------------------------------------------------ separating axes

/// The axis of the face of a polyhedron in front of which the triangle is farthest.
TriangleNearest along_face(const MeshFace& face, const SolidInMesh& solid) {
  const Polyhedron& p = *solid.shape().polyhedron;
  TriangleNearest best;
  best.separation = -1e300;
  for (std::size_t f = 0; f < solid.normals().size(); ++f) {
    const Vec3d &normal = solid.normals()[f], lowest = lowest_corner(face, normal);
    const auto corner = static_cast<std::size_t>(p.face_corners[static_cast<std::size_t>(p.first_of_face[f])]);
    const double separation = dot(normal, lowest - solid.corners()[corner]);
    if (separation <= best.separation) continue;
    best = {false, -normal, separation, lowest, lowest - normal * separation};
  }
  return best;
}

/// True if an edge of a polyhedron is its farthest part in a direction, which is perpendicular to it.
bool is_farthest(const SolidInMesh& solid, const PolyhedronEdge& edge, const Vec3d& direction) {
  const Vec3d &left = solid.normals()[static_cast<std::size_t>(edge.left)],
              &right = solid.normals()[static_cast<std::size_t>(edge.right)];
  const Vec3d turn = cross(left, right);
  return dot(cross(left, direction), turn) >= 0 && dot(cross(direction, right), turn) >= 0;
}

/// The best axis across an edge of each: of lines whose directions are farthest parts of both.
TriangleNearest along_edges(const MeshFace& face, const SolidInMesh& solid) {
  TriangleNearest best;
  best.separation = -1e300;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d &t = face.corners[k], side = face.corners[(k + 1) % 3] - t, &outward = face.sides[k].outward;
    for (const PolyhedronEdge& edge : solid.shape().polyhedron->edges) {
      const Vec3d& p = solid.corners()[static_cast<std::size_t>(edge.a)];
      const Vec3d along = solid.corners()[static_cast<std::size_t>(edge.b)] - p, across = cross(side, along);
      const double squared = length_squared(across);
      if (squared <= parallel * parallel * length_squared(side) * length_squared(along)) continue;
      const Vec3d normal = across * ((dot(across, outward) < 0 ? -1 : 1) / std::sqrt(squared));
      const double separation = dot(normal, p - t);
      if (separation <= best.separation || !is_farthest(solid, edge, -normal)) continue;
      const Vec3d of_triangle[2] = {t, t + side}, of_solid[2] = {p, p + along};
      const auto ends = closest_on_segments(of_triangle, of_solid);
      best = {false, normal, separation, ends.first, ends.second};
    }
  }
  return best;
}

TriangleNearest best_axis(const MeshFace& face, const SolidInMesh& solid, TriangleNearest best, double reach) {
  const double tolerance = preference * solid.size();
  const TriangleNearest by_face = along_face(face, solid);
  if (by_face.separation > best.separation + tolerance) best = by_face;
  if (best.separation > reach) return best;
  const TriangleNearest by_edges = along_edges(face, solid);
  if (by_edges.separation > best.separation + tolerance) best = by_edges;
  return best;
}

}  // namespace

Vec3d facing_normal(const MeshFace& face, const Vec3d& point, bool is_one_sided) {
  return !is_one_sided && dot(face.normal, point - face.corners[0]) < 0 ? -face.normal : face.normal;
}

TriangleNearest exactly_nearest_on(const MeshFace& face, const SolidInMesh& solid, const Vec3d& displacement) {
  if (solid.shape().kind == ConvexShape::Kind::point) {
    TriangleNearest out = nearest_of_point(face, solid.pose().position + displacement);
    out.is_near = true;
    return out;
  }
  return nearest_by_supports(face, solid, 1e300, displacement);
}

TriangleNearest nearest_on(const MeshFace& face, const SolidInMesh& solid, double reach, bool is_one_sided) {
  TriangleNearest out;
  if (solid.shape().kind == ConvexShape::Kind::point) {
    out = nearest_of_point(face, solid.pose().position);
  } else {
    out = along_normal(face, solid, is_one_sided);
    if (out.separation > reach) return {};
    const bool is_smooth = face.is_smooth[dot(out.normal, face.normal) < 0 ? 1 : 0];
    const bool is_above = is_over_triangle(face, out.on_solid, 0);
    // What is less deep below an edge than beside it is pushed out over that edge.
    const bool is_at_edge = is_above && out.separation < 0 && !is_over_triangle(face, out.on_solid, -out.separation);
    const bool is_shallow = out.separation > -shallow * solid.size();
    if (is_smooth && !is_shallow && !is_one_sided) {
      // What is deep below the plane may be beside the triangle, and outside of what is smooth as seen from within. It
      // may touch it there: a box on top of a wall, whose centre has passed the plane of the wall's side.
      TriangleNearest exact = nearest_by_supports(face, solid, reach);
      exact.is_near = exact.separation <= reach;
      if (exact.separation > beside_share * out.separation) return exact;
    }
    const bool is_face_contact = !is_at_edge && (is_smooth || (is_shallow && is_above));
    if (!is_face_contact && solid.is_polyhedron()) out = best_axis(face, solid, out, reach);
    if (out.separation > reach) return {};
    if (!is_face_contact && (out.separation > 0 || !solid.is_polyhedron()))
      out = nearest_by_supports(face, solid, reach);
  }
  out.is_near = out.separation <= reach;
  return out;
}

}  // namespace pliant
