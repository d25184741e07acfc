// Makes closed triangle meshes of the solids of rigid bodies.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "geometry/convex_hull.h"
#include "math/functions.h"
#include "math/quat.h"
#include "pliant/body.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// A point of the outline that is turned about the y-axis; a radius of 0 makes one vertex.
struct Outline {
  double radius, y;
};

/// Adds the triangles between two neighbouring rings, of which one may be a single vertex.
void join(TriangleMesh& mesh, int upper, int upper_count, int lower, int lower_count) {
  const int sides = std::max(upper_count, lower_count);
  for (int side = 0; side < sides && sides > 1; ++side) {
    const int next = (side + 1) % sides;
    if (lower_count > 1) mesh.triangles.push_back({upper + (upper_count > 1 ? side : 0), lower + side, lower + next});
    if (upper_count > 1) mesh.triangles.push_back({upper + side, lower + (lower_count > 1 ? next : 0), upper + next});
  }
}

/// Turns an outline, which goes from the top of a solid to its bottom, about the y-axis.
TriangleMesh revolved(const std::vector<Outline>& outline, int segments) {
  TriangleMesh mesh;
  int before = 0, before_count = 0;
  for (const Outline& at : outline) {
    const int first = static_cast<int>(mesh.positions.size()), count = at.radius > 0 ? segments : 1;
    for (int side = 0; side < count; ++side) {
      const SineCosine turn = sine_cosine(2 * std::numbers::pi * side / segments);
      mesh.positions.push_back(convert<float>(Vec3d{at.radius * turn.sine, at.y, at.radius * turn.cosine}));
    }
    if (first > 0) join(mesh, before, before_count, first, count);
    before = first, before_count = count;
  }
  return mesh;
}

/// Two half balls whose centres are `half_length` above and below the middle.
TriangleMesh capsule_mesh(double radius, double half_length, int segments) {
  std::vector<Outline> outline;
  const int steps = segments / 4;  // from a pole to the equator
  for (int step = 0; step <= 2 * steps; ++step) {
    const SineCosine turn = sine_cosine(0.5 * std::numbers::pi * step / steps);
    const bool is_pole = step == 0 || step == 2 * steps;
    const double shift = step <= steps ? half_length : -half_length;
    outline.push_back({is_pole ? 0 : radius * turn.sine, radius * turn.cosine + shift});
    if (step == steps && half_length > 0) outline.push_back({radius, -half_length});
  }
  return revolved(outline, segments);
}

TriangleMesh box_mesh(const Vec3f& half) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.positions.push_back({(corner & 1) != 0 ? half.x : -half.x, (corner & 2) != 0 ? half.y : -half.y,
                              (corner & 4) != 0 ? half.z : -half.z});
  for (int axis = 0; axis < 3; ++axis) {
    const int out = 1 << axis, u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
    mesh.triangles.push_back({out, out | u, out | u | v});
    mesh.triangles.push_back({out, out | u | v, out | v});
    mesh.triangles.push_back({0, u | v, u});
    mesh.triangles.push_back({0, v, u | v});
  }
  return mesh;
}

/// A hull with a margin is drawn as the hull of a small ball about each of its corners.
TriangleMesh hull_mesh(const Hull& hull) {
  std::optional<ConvexHull> found = convex_hull(hull.points);
  if (found && hull.margin > 0) {
    std::vector<Vec3f> points;
    for (const Vec3f& corner : found->corners)
      for (const Vec3f& way : sphere_mesh(1).positions) points.push_back(corner + way * hull.margin);
    found = convex_hull(points);
  }
  if (!found)
    throw Error({"", 0, "", "hull of " + std::to_string(hull.points.size()) + " points"}, "lies in one plane",
                "give points that enclose a volume");
  return {found->corners, found->triangles()};
}

struct MeshOf {
  int segments;

  TriangleMesh operator()(const Sphere& s) const { return capsule_mesh(s.radius, 0, segments); }
  TriangleMesh operator()(const Capsule& s) const { return capsule_mesh(s.radius, s.half_length, segments); }
  TriangleMesh operator()(const Box& s) const { return box_mesh(s.half_extents); }
  TriangleMesh operator()(const Cylinder& s) const {
    const double r = s.radius, h = s.half_length;
    return revolved({{0, h}, {r, h}, {r, -h}, {0, -h}}, segments);
  }
  TriangleMesh operator()(const Cone& s) const {
    const double r = s.radius, h = s.half_length;
    return revolved({{0, h}, {r, -h}, {0, -h}}, segments);
  }
  TriangleMesh operator()(const Hull& s) const { return hull_mesh(s); }
};

}  // namespace

TriangleMesh mesh_of(const std::vector<Solid>& solids, int segments) {
  constexpr int least = 8, most = 512;
  if (segments < least || segments > most)
    throw Error({}, "round solids cannot have " + std::to_string(segments) + " segments", "choose 8 to 512");
  TriangleMesh all;
  for (const Solid& solid : solids) {
    const TriangleMesh one = std::visit(MeshOf{segments / 4 * 4}, solid.shape);
    const int first = static_cast<int>(all.positions.size());
    const Quatd rotation = normalise(convert<double>(solid.rotation));
    for (const Vec3f& p : one.positions)
      all.positions.push_back(convert<float>(rotate(rotation, convert<double>(p)) + convert<double>(solid.position)));
    for (const auto& [a, b, c] : one.triangles) all.triangles.push_back({first + a, first + b, first + c});
  }
  return all;
}

}  // namespace pliant
