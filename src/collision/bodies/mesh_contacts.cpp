#include "collision/bodies/mesh_contacts.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "collision/bodies/triangle_contact.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// Manifolds whose normals agree better than this are one [cosine].
constexpr double alike_cosine = 0.995;
/// A direction this close to a triangle's normal is that normal [cosine].
constexpr double own_cosine = 1 - 1e-6;
/// Points nearer to each other than this share of the solid's size are one.
constexpr double coincident_share = 1e-4;

/// The points of one triangle: points[first] to points[end].
struct Group {
  int triangle = 0;
  std::size_t first = 0, end = 0;
  double deepest = 0;
};

/// Triangles that share a manifold, around the one that is touched most.
struct Cluster {
  Vec3d normal{};
  int piece = 0;
  std::vector<TrianglePoint> points;
};

std::vector<Group> groups_of(const std::vector<TrianglePoint>& points) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TrianglePoint& at = points[i];
    if (groups.empty() || groups.back().triangle != at.triangle)
      groups.push_back({at.triangle, i, i, at.point.separation});
    groups.back().end = i + 1;
    groups.back().deepest = std::min(groups.back().deepest, at.point.separation);
  }
  std::sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
    return a.deepest != b.deepest ? a.deepest < b.deepest : a.triangle < b.triangle;
  });
  return groups;
}

/// Adds points, but for those that are there already: neighbouring triangles share what lies on their edge.
void add_points(Cluster& cluster, const std::vector<TrianglePoint>& points, const Group& group, double tolerance) {
  cluster.piece = std::min(cluster.piece, group.triangle);
  for (std::size_t i = group.first; i < group.end; ++i) {
    const bool is_there = std::any_of(cluster.points.begin(), cluster.points.end(), [&](const TrianglePoint& other) {
      return length_squared(other.point.on_b - points[i].point.on_b) <= tolerance * tolerance;
    });
    if (!is_there) cluster.points.push_back(points[i]);
  }
}

/// Triangles that are met at different places share a manifold only if it has the same direction at each.
bool belongs_to(const Cluster& cluster, const TrianglePoint& at) {
  const Vec3d apart = cluster.points.front().moved - at.moved;
  return dot(cluster.normal, at.normal) > (length_squared(apart) > 0 ? own_cosine : alike_cosine);
}

std::vector<Cluster> clusters_of(const std::vector<TrianglePoint>& points, double tolerance) {
  std::vector<Cluster> clusters;
  for (const Group& group : groups_of(points)) {
    const Vec3d& normal = points[group.first].normal;
    auto place = std::find_if(clusters.begin(), clusters.end(),
                              [&](const Cluster& c) { return belongs_to(c, points[group.first]); });
    if (place == clusters.end()) place = clusters.insert(place, {normal, group.triangle, {}});
    add_points(*place, points, group, tolerance);
  }
  return clusters;
}

/// Puts four points in order around their area, as those of other contacts are: passes of the solver count on points 0
/// and 2 being opposite each other, as 1 and 3 are. Those of a mesh come triangle by triangle, and a flat impact would
/// turn a solid.
Touch around(Touch touch) {
  if (touch.count < 4) return touch;
  auto& p = touch.points;
  const auto apart = [&](std::size_t a, std::size_t b) { return length(p[a].on_b - p[b].on_b); };
  const double now = apart(0, 2) + apart(1, 3), swapped_1_2 = apart(0, 1) + apart(2, 3),
               swapped_2_3 = apart(0, 3) + apart(1, 2);
  constexpr double longer = 1 + 1e-6;
  if (swapped_1_2 > longer * std::max(now, swapped_2_3))
    std::swap(p[1], p[2]);
  else if (swapped_2_3 > longer * now)
    std::swap(p[2], p[3]);
  return touch;
}

/// Four points of a cluster with the mean of their normals, so that a solid on a curved mesh is not held by one
/// triangle's.
Touch touch_of(const Cluster& cluster) {
  Vec3d sum{};
  for (const TrianglePoint& at : cluster.points) sum += at.normal;
  const Vec3d normal = cluster.points.size() == 1 ? cluster.normal : unit_or(sum, cluster.normal);
  const Vec3d& moved = cluster.points.front().moved;
  std::vector<TouchPoint> points;
  for (const TrianglePoint& at : cluster.points) {
    TouchPoint point = at.point;
    point.on_b += moved;
    point.separation = point.separation * dot(at.normal, normal) + dot(normal, moved);
    point.on_a = point.on_b - normal * point.separation;
    points.push_back(point);
  }
  return around(four_of(points, normal));
}

/// The triangle of terrain above the centre of a solid that has sunk below it, else -1.
int triangle_above(const BodyMesh& mesh, const SolidInMesh& solid) {
  if (!mesh.is_terrain()) return -1;
  const int triangle = mesh.triangle_in_column(solid.centre());
  if (triangle < 0) return -1;
  const MeshFace& face = mesh.face(triangle);
  return dot(face.normal, solid.centre() - face.corners[0]) <= 0 ? triangle : -1;
}

std::vector<TrianglePoint> points_on(const BodyMesh& mesh, const SolidInMesh& solid, double reach,
                                     const SolidPath* path, PathContact& first) {
  std::vector<TrianglePoint> points;
  std::vector<int> near;
  int plane = triangle_above(mesh, solid);
  if (plane < 0) {
    mesh.find(solid.box(reach + mesh.thickness()), near);
    for (const int triangle : near) touch_triangle(solid, mesh, triangle, reach, points);
    if (path != nullptr) first = put_on_path(solid, mesh, near, reach, *path, points);
    // Deep inside a fine mesh no triangle may be below the solid's lowest points.
    if (points.empty()) plane = least_overlapped(solid, mesh, near);
  }
  if (plane >= 0)
    touch_plane_of(solid, mesh, plane, facing_normal(mesh.face(plane), solid.centre(), mesh.is_terrain()), reach,
                   points);
  return points;
}

}  // namespace

PathContact touch_mesh(const ConvexShape& shape, const Posed& pose_in_mesh, const BodyMesh& mesh, double reach,
                       std::vector<MeshTouch>& found, double turning, const SolidPath* path) {
  found.clear();
  const SolidInMesh solid(shape, pose_in_mesh, turning);
  PathContact first;
  const std::vector<TrianglePoint> points = points_on(mesh, solid, reach, path, first);
  for (const Cluster& cluster : clusters_of(points, coincident_share * solid.size()))
    found.push_back({cluster.piece, touch_of(cluster), cluster.points.front().moved});
  std::sort(found.begin(), found.end(), [](const MeshTouch& a, const MeshTouch& b) { return a.piece < b.piece; });
  return first;
}

MeshTouch touch_side(const ConvexShape& shape, const Posed& pose_in_mesh, const BodyMesh& mesh,
                     const MeshSideKept& kept, double reach, double turning) {
  std::vector<TrianglePoint> points;
  const SolidInMesh solid(shape, pose_in_mesh, turning);
  touch_plane_of(solid, mesh, kept.triangle, kept.normal, reach, points);
  const std::vector<Cluster> clusters = clusters_of(points, coincident_share * solid.size());
  return clusters.empty() ? MeshTouch{} : MeshTouch{kept.triangle, touch_of(clusters.front()), {}};
}

}  // namespace pliant
