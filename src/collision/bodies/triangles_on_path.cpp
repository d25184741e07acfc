#include "collision/bodies/triangles_on_path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "collision/bodies/triangle_nearest.h"
#include "geometry/triangle.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// A triangle that is met, and where.
struct Met {
  int triangle = 0;
  std::size_t first = 0, end = 0;  ///< its points at the start of the path
  PathContact at;

  std::span<const TrianglePoint> points(const std::vector<TrianglePoint>& at_start) const {
    return std::span(at_start).subspan(first, end - first);
  }
};

/// A solid on its path, and a mesh.
struct Way {
  const SolidInMesh& solid;
  const BodyMesh& mesh;
  double reach;
  const SolidPath& on;

  double radii() const { return solid.radius() + mesh.thickness(); }

  /// True of a point in the direction of its triangle's own normal.
  bool is_of_face(const TrianglePoint& at) const {
    return std::fabs(dot(at.normal, mesh.face(at.triangle).normal)) > 1 - 1e-9;
  }
  /// True if points stop the solid on a path, by what counts as touching on it.
  static bool stops(const SolidPath& by, std::span<const TrianglePoint> points) {
    return std::any_of(points.begin(), points.end(),
                       [&](const TrianglePoint& at) { return by.is_stopped(at.normal, at.point.separation); });
  }
  bool stops(const ContactPath& path, std::span<const TrianglePoint> points) const {
    return stops(SolidPath{path, on.slop, on.sag, on.least}, points);
  }
  /// True if a path takes the solid deeper in than points of it may be.
  bool goes_in(const ContactPath& path, std::span<const TrianglePoint> points) const {
    return stops(SolidPath{path, on.slop, -on.slop, on.least}, points);
  }
  /// True if the points of a face that the solid passes serve as they are: unless the path goes in, they stop nothing.
  bool stays(const ContactPath& path, const std::vector<TrianglePoint>& points, const Met& of) const {
    return of.end > of.first && is_of_face(points[of.first]) && !goes_in(path, of.points(points));
  }

  /// True if a path may take the solid lower over a triangle than `height` [m]: neither along the triangle's normal nor
  /// along that from the triangle to the solid's centre does it stay higher. Hills beside a wheel are below its plane.
  bool passes(const ContactPath& path, int triangle, const BoxBounds& swept, double height) const {
    const MeshFace& face = mesh.face(triangle);
    if (!(length_squared(face.normal) > 0)) return false;
    for (const double Vec3d::*axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
      const auto [least, most] = std::minmax({face.corners[0].*axis, face.corners[1].*axis, face.corners[2].*axis});
      if (most < low(swept, axis) || least > high(swept, axis)) return false;
    }
    const Vec3d normal = facing_normal(face, solid.centre(), mesh.is_terrain());
    if (!(least_along(path, face, normal) < height)) return false;
    const auto& [a, b, c] = face.corners;
    const Vec3d away = solid.centre() - closest_on_triangle(solid.centre(), a, b, c).point;
    if (mesh.is_terrain() && dot(away, normal) < 0) return true;  // the centre is below the surface
    return !(length_squared(away) > 0) || least_along(path, face, away * (1 / length(away))) < height;
  }
  /// How far a path keeps the solid from a triangle along a direction, at least [m].
  double least_along(const ContactPath& path, const MeshFace& face, const Vec3d& normal) const {
    const auto& [a, b, c] = face.corners;
    const double top = std::max({dot(normal, a), dot(normal, b), dot(normal, c)});
    return dot(normal, solid.support(-normal)) - top - radii() + path.least_along(normal);
  }
  static double low(const BoxBounds& box, const double Vec3d::*axis) { return convert<double>(box.low).*axis; }
  static double high(const BoxBounds& box, const double Vec3d::*axis) { return convert<double>(box.high).*axis; }

  PathContact meet(const ContactPath& path, int triangle) const {
    const MeshFace& face = mesh.face(triangle);
    const auto gap_at = [&](const Vec3d& displacement) -> PathGap {
      const TriangleNearest nearest = exactly_nearest_on(face, solid, displacement);
      return {nearest.separation - radii(), nearest.normal};
    };
    return PathSearch(path, on.slop, gap_at).find();
  }
};

BoxBounds swept(const SolidInMesh& solid, const ContactPath& path, double margin) {
  const BoxBounds box = solid.box(margin);
  BoxBounds all = box;
  for (std::size_t i = 0; i < path.count(); ++i) {
    const Vec3f by = convert<float>(path.at(path.leg(i), 1));
    all.low = min(all.low, box.low + by);
    all.high = max(all.high, box.high + by);
  }
  return all;
}

/// The triangles that may be met on a path, in the order of `near`, which is that of the points: those whose planes the
/// solid passes lower than `height` [m].
std::vector<Met> met_on(const Way& way, const ContactPath& path, const std::vector<int>& near,
                        const std::vector<TrianglePoint>& points, double height) {
  const BoxBounds box = swept(way.solid, path, way.mesh.thickness() + way.on.sag);
  std::vector<Met> all;
  std::size_t next = 0;
  for (const int triangle : near) {
    Met met{triangle, next, next, {}};
    while (met.end < points.size() && points[met.end].triangle == triangle) ++met.end;
    next = met.end;
    if (way.stops(path, met.points(points)) || way.passes(path, triangle, box, height)) all.push_back(met);
  }
  return all;
}

/// The first touch of any. `is_enough`: the others are not asked for where none can be earlier.
PathContact first_of(std::vector<Met>& met, const Way& way, const ContactPath& path, bool is_enough) {
  PathContact first;
  for (Met& one : met) {
    one.at = way.meet(path, one.triangle);
    if (!one.at.touches) continue;
    one.at.normal = direction_of_contact(way.solid.moved(one.at.displacement), way.mesh, one.triangle, one.at.normal);
    if (!first.touches || one.at.time < first.time) first = one.at;
    if (is_enough && first.time <= 0) return first;
  }
  return first;
}

/// Appends the points of a triangle at the place where it is met, as seen from the start of the path. One that is
/// passed and has none there keeps those of the start if they stop nothing: where it is passed the solid may be over
/// its neighbours, and what spins or is pushed would find no contact there.
void add_points(const Way& way, const ContactPath& path, const std::vector<TrianglePoint>& at_start, const Met& met,
                std::vector<TrianglePoint>& points) {
  const std::size_t first = points.size();
  const Vec3d& by = met.at.displacement;
  const SolidInMesh there = way.solid.moved(by);
  if (met.at.touches) {
    touch_triangle(there, way.mesh, met.triangle, way.reach, points);
    if (points.size() == first) touch_beyond_valley(there, way.mesh, met.triangle, way.reach, points);
  } else {  // no direction is preferred where they pass
    TriangleNearest nearest = exactly_nearest_on(way.mesh.face(met.triangle), there, {});
    nearest.normal = met.at.normal;
    nearest.separation = dot(nearest.normal, nearest.on_solid - nearest.on_triangle);
    touch_triangle(there, way.mesh, met.triangle, way.reach, nearest, points);
  }
  for (std::size_t i = first; i < points.size(); ++i) {
    points[i].moved = by;
    points[i].point.on_b -= by;
    points[i].point.separation -= dot(points[i].normal, by);
  }
  if (met.at.touches) return;
  // What passes beside a triangle goes below its plane there.
  if (!has_direction(there, way.mesh, met.triangle, met.at.normal) &&
      way.goes_in(path, std::span(points).subspan(first)))
    points.resize(first);
  if (points.size() == first && way.stays(path, at_start, met))
    points.insert(points.end(), at_start.begin() + static_cast<std::ptrdiff_t>(met.first),
                  at_start.begin() + static_cast<std::ptrdiff_t>(met.end));
}

}  // namespace

PathContact put_on_path(const SolidInMesh& solid, const BodyMesh& mesh, const std::vector<int>& near, double reach,
                        const SolidPath& on, std::vector<TrianglePoint>& points) {
  const Way way{solid, mesh, reach, on};
  ContactPath path = on.path;
  std::vector<Met> met = met_on(way, path, near, points, -on.slop);
  if (met.empty()) return {};
  const PathContact first = first_of(met, way, path, met.size() > 1);
  if (first.touches && met.size() > 1) {
    path.turn(first.time, first.normal * -std::min(dot(first.normal, path.speed_at(first.time)), 0.));
    met = met_on(way, path, near, points, on.slop);  // what has been touched is not passed, yet holds the solid
    first_of(met, way, path, false);
  }
  std::vector<TrianglePoint> out;
  std::size_t next = 0;
  for (const Met& one : met) {
    out.insert(out.end(), points.begin() + static_cast<std::ptrdiff_t>(next),
               points.begin() + static_cast<std::ptrdiff_t>(one.first));
    add_points(way, path, points, one, out);
    next = one.end;
  }
  out.insert(out.end(), points.begin() + static_cast<std::ptrdiff_t>(next), points.end());
  // Where something is touched, some contact has to hold the solid, be it in another direction.
  if (!out.empty() || !first.touches) points.swap(out);
  return first;
}

}  // namespace pliant
