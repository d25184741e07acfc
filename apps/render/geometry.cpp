// Makes triangles of shapes, lines and meshes.
#include "geometry.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "io/write_frames.h"
#include "matrix.h"
#include "pliant/error.h"
#include "stones.h"
#include "walls.h"

namespace pliant::render {

namespace {

constexpr int around_steps = 64;  // segments of round shapes around their axis
constexpr int tube_sides = 12;

/// Adds the quads between neighbouring rings of vertices, which all have the same number of vertices.
void join_rings(Geometry& geometry, std::uint32_t first, std::uint32_t rings, std::uint32_t sides) {
  for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t next = (side + 1) % sides;
      const std::uint32_t a = first + ring * sides + side, b = first + ring * sides + next;
      geometry.indices.insert(geometry.indices.end(), {a, a + sides, b, b, a + sides, b + sides});
    }
  }
}

/// Adds a capsule: a sphere that is cut in two and extended along y by twice `half_length`; 0 makes a sphere.
void add_capsule(Geometry& geometry, float radius, float half_length, int steps) {
  const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
  const int rings = steps / 2 + 2;
  for (int ring = 0; ring < rings; ++ring) {
    // The ring at the equator occurs twice, once for each half.
    const int step = ring < rings / 2 ? ring : ring - 1;
    const float polar = pi * static_cast<float>(step) / static_cast<float>(rings - 2);
    for (int side = 0; side < steps; ++side) {
      const float angle = 2 * pi * static_cast<float>(side) / static_cast<float>(steps);
      const Vec3f normal{std::sin(polar) * std::sin(angle), std::cos(polar), std::sin(polar) * std::cos(angle)};
      const Vec3f shift{0, ring < rings / 2 ? half_length : -half_length, 0};
      geometry.vertices.push_back({normal * radius + shift, normal});
    }
  }
  join_rings(geometry, first, static_cast<std::uint32_t>(rings), static_cast<std::uint32_t>(steps));
}

void add_box(Geometry& geometry, const Vec3f& low, const Vec3f& high) {
  const Vec3f middle = (low + high) * 0.5f, half = (high - low) * 0.5f;
  const Vec3f axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto scaled = [&](const Vec3f& v) { return Vec3f{v.x * half.x, v.y * half.y, v.z * half.z}; };
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.f, 1.f}) {
      const Vec3f normal = axes[axis] * sign, u = axes[(axis + 1) % 3], v = cross(normal, u);
      const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
      for (const auto& [a, b] : {std::pair{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}})
        geometry.vertices.push_back({middle + scaled(normal + u * a + v * b), normal});
      geometry.indices.insert(geometry.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }
  }
}

void place(Geometry& geometry, const Vec3f& position, const Quatf& rotation) {
  for (Vertex& vertex : geometry.vertices) {
    vertex.position = rotate(rotation, vertex.position) + position;
    vertex.normal = rotate(rotation, vertex.normal);
  }
}

Geometry build_ball(const Vec3f& centre, float radius, const Vec3f& colour) {
  Geometry ball{.vertices = {}, .indices = {}, .colour = colour, .material = Material::solid};
  add_capsule(ball, radius, 0, 16);
  place(ball, centre, {});
  return ball;
}

void append(Geometry& geometry, const Geometry& other) {
  const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
  geometry.vertices.insert(geometry.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const std::uint32_t i : other.indices) geometry.indices.push_back(first + i);
}

/// Makes a tube: rings along the line in a frame without twist, and a ball at each end.
Geometry build_tube(const RenderTube& tube, float least_radius) {
  Geometry result{.vertices = {}, .indices = {}, .colour = tube.colour, .material = Material::solid};
  const std::size_t count = tube.points.size();
  if (count == 0) return result;
  const auto radius = [&](std::size_t i) {
    return std::max(tube.radii.empty() ? tube.radius : tube.radii[i], least_radius);
  };
  append(result, build_ball(tube.points.front(), radius(0), tube.colour));
  if (count == 1) return result;
  append(result, build_ball(tube.points.back(), radius(count - 1), tube.colour));
  const auto first = static_cast<std::uint32_t>(result.vertices.size());
  Vec3f side = view_frame(tube.points[1] - tube.points[0]).right;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3f before = tube.points[i == 0 ? 0 : i - 1], after = tube.points[std::min(i + 1, count - 1)];
    const Vec3f along = unit(after - before);
    side = unit(side - along * dot(side, along), view_frame(along).right);
    const Vec3f other = cross(side, along);
    for (int k = 0; k < tube_sides; ++k) {
      const float angle = 2 * pi * static_cast<float>(k) / tube_sides;
      const Vec3f normal = side * std::cos(angle) + other * std::sin(angle);
      result.vertices.push_back({tube.points[i] + normal * radius(i), normal});
    }
  }
  join_rings(result, first, static_cast<std::uint32_t>(count), tube_sides);
  return result;
}

/// A plane is infinite, so a finite slab of it is drawn, below the centre of the scene.
void add_slab(Geometry& geometry, const RenderCollider& plane, const Vec3f& around, float radius) {
  const Quatf back{-plane.rotation.x, -plane.rotation.y, -plane.rotation.z, plane.rotation.w};
  Vec3f middle = rotate(back, around - plane.position);
  middle.y = 0;
  const float half = 1.25f * radius;
  add_box(geometry, middle - Vec3f{half, 0.04f * radius, half}, middle + Vec3f{half, 0, half});
}

Geometry build_collider(const RenderCollider& collider, const Vec3f& around, float radius) {
  Geometry geometry{.vertices = {}, .indices = {}, .colour = collider.colour, .material = Material::solid};
  if (const auto* sphere = std::get_if<Sphere>(&collider.shape)) add_capsule(geometry, sphere->radius, 0, around_steps);
  if (const auto* c = std::get_if<Capsule>(&collider.shape))
    add_capsule(geometry, c->radius, c->half_length, around_steps);
  if (const auto* box = std::get_if<Box>(&collider.shape)) add_box(geometry, -box->half_extents, box->half_extents);
  if (std::holds_alternative<Plane>(collider.shape)) add_slab(geometry, collider, around, radius);
  place(geometry, collider.position, collider.rotation);
  return geometry;
}

/// The normals of a mesh's triangles times twice their areas.
std::vector<Vec3f> face_normals(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 3>>& triangles) {
  std::vector<Vec3f> faces;
  faces.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles)
    faces.push_back(cross(positions[b] - positions[a], positions[c] - positions[a]));
  return faces;
}

/// The share of its colour that a vertex keeps: a wet one is darker.
float shade_of(const RenderMesh& mesh, std::size_t vertex) {
  constexpr float dark = 0.55f;  // what a full one loses of its colour
  return mesh.wetness.empty() ? 1 : 1 - dark * std::min(mesh.wetness[vertex], 1.f);
}

std::array<float, 2> checks_of(const RenderMesh& mesh, std::size_t vertex) {
  return mesh.checks.empty() ? std::array<float, 2>{} : mesh.checks[vertex];
}

/// Makes a mesh in which triangles share no vertices. A normal is the mean over adjacent faces that have similar
/// directions in the mesh's own shape, so round shapes look smooth and edges sharp.
Geometry build_creased(const RenderMesh& mesh, Material material) {
  constexpr float about = 0.8f;  // cosine of the largest angle between faces that are smoothed
  Geometry geometry{
      .vertices = {}, .indices = {}, .colour = mesh.colour, .material = material, .clarity = mesh.clarity};
  const std::vector<Vec3f> faces = face_normals(mesh.positions, mesh.triangles);
  std::vector<Vec3f> directions = mesh.creased.empty() ? faces : face_normals(mesh.creased, mesh.triangles);
  for (Vec3f& direction : directions) direction = unit(direction);
  std::vector<std::vector<std::size_t>> around(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int corner : mesh.triangles[t]) around[corner].push_back(t);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int corner : mesh.triangles[t]) {
      Vec3f normal{};
      for (const std::size_t other : around[corner])
        if (dot(directions[other], directions[t]) > about) normal += faces[other];
      geometry.indices.push_back(static_cast<std::uint32_t>(geometry.vertices.size()));
      geometry.vertices.push_back(
          {mesh.positions[corner], unit(normal), shade_of(mesh, static_cast<std::size_t>(corner))});
    }
  }
  return geometry;
}

/// Makes the geometry of each body: that of its mesh, which is made once, in the body's pose and colour.
void add_bodies(const std::vector<RenderBody>& bodies, std::vector<Geometry>& result) {
  std::map<const TriangleMesh*, Geometry> made;
  for (const RenderBody& body : bodies) {
    const auto [found, is_new] = made.try_emplace(body.mesh.get());
    if (is_new)
      found->second = build_creased({.positions = body.mesh->positions,
                                     .triangles = body.mesh->triangles,
                                     .colour = body.colour,
                                     .is_solid = true},
                                    Material::solid);
    Geometry geometry = found->second;
    geometry.colour = body.colour;
    place(geometry, body.pose.position, body.pose.rotation);
    result.push_back(std::move(geometry));
  }
}

/// The corners of the box around a body's mesh, in the world.
std::array<Vec3f, 8> box_corners(const Bounds& box, const RigidPose& pose) {
  std::array<Vec3f, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3f corner{(i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                       (i & 4) != 0 ? box.high.z : box.low.z};
    corners[i] = rotate(pose.rotation, corner) + pose.position;
  }
  return corners;
}

/// A body's mesh has this radius about the middle of its box [m]; 0 without a mesh.
float radius_of(const RenderBody& body, std::map<const TriangleMesh*, Bounds>& boxes) {
  const auto [found, is_new] = boxes.try_emplace(body.mesh.get());
  if (is_new) found->second = bounds(body.mesh->positions);
  return found->second.radius();
}

/// The corners of the boxes around all bodies that are fixed, or all that are not, with radii above `least` and up to
/// `largest`.
std::vector<Vec3f> corners_of_bodies(const RenderScene& scene, bool fixed, float least, float largest) {
  std::vector<Vec3f> points;
  std::map<const TriangleMesh*, Bounds> boxes;
  for (const RenderBody& body : scene.bodies) {
    if (body.is_fixed != fixed || body.mesh->positions.empty()) continue;
    const float radius = radius_of(body, boxes);
    if (!(radius > least) || radius > largest) continue;
    const auto corners = box_corners(boxes.at(body.mesh.get()), body.pose);
    points.insert(points.end(), corners.begin(), corners.end());
  }
  return points;
}

/// The middle one of the radii of bodies that are not fixed [m]; 0 without any.
float usual_radius(const RenderScene& scene) {
  std::vector<float> radii;
  std::map<const TriangleMesh*, Bounds> boxes;
  for (const RenderBody& body : scene.bodies)
    if (!body.is_fixed && !body.mesh->positions.empty()) radii.push_back(radius_of(body, boxes));
  if (radii.empty()) return 0;
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

/// Adds the points of a liquid, free particles or bodies, but for the few that lie far from the others: a camera that
/// framed every drop of a splash would show the rest small.
void include_most(const std::vector<Vec3f>& positions, std::vector<Vec3f>& points) {
  constexpr float few = 0.025f, around = 0.25f;  // shares of the points on each side, and of their size
  if (positions.empty()) return;
  Vec3f low{}, high{};
  std::vector<float> along(positions.size());
  const auto rank = static_cast<std::ptrdiff_t>(few * static_cast<float>(positions.size()));
  for (float Vec3f::*const axis : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
    std::transform(positions.begin(), positions.end(), along.begin(), [&](const Vec3f& p) { return p.*axis; });
    std::nth_element(along.begin(), along.begin() + rank, along.end());
    low.*axis = along[static_cast<std::size_t>(rank)];
    std::nth_element(along.begin(), along.end() - 1 - rank, along.end());
    high.*axis = along[along.size() - 1 - static_cast<std::size_t>(rank)];
  }
  const Vec3f margin = (high - low) * around;
  low -= margin, high += margin;
  std::copy_if(positions.begin(), positions.end(), std::back_inserter(points), [&](const Vec3f& p) {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
  });
}

/// Makes one ball of radius 1, coarser if there are many, and the place of each.
Geometry build_balls(const RenderBalls& balls, float least_radius) {
  const Material material = balls.are_grains ? Material::grains : Material::solid;
  Geometry geometry{.vertices = {}, .indices = {}, .colour = balls.colour, .material = material};
  add_capsule(geometry, 1, 0, balls.centres.size() < 10000 ? 16 : 8);
  if (balls.are_grains) make_uneven(geometry);
  const float radius = std::max(balls.radius, least_radius);
  for (const Vec3f& centre : balls.centres) geometry.places.push_back({centre.x, centre.y, centre.z, radius});
  return geometry;
}

Geometry build_mesh(const RenderMesh& mesh) {
  if (mesh.is_solid) return build_creased(mesh, Material::solid);
  const Material material = mesh.is_liquid ? Material::liquid : mesh.clarity > 0 ? Material::jelly : Material::cloth;
  if (!mesh.creased.empty()) return build_creased(mesh, material);
  Geometry geometry{
      .vertices = {}, .indices = {}, .colour = mesh.colour, .material = material, .clarity = mesh.clarity};
  geometry.checked = !mesh.checks.empty();
  const std::vector<Vec3f> normals = output::vertex_normals(mesh.positions, mesh.triangles);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    geometry.vertices.push_back({mesh.positions[i], normals[i], shade_of(mesh, i), checks_of(mesh, i)});
  for (const auto& triangle : mesh.triangles)
    for (const int i : triangle) geometry.indices.push_back(static_cast<std::uint32_t>(i));
  return geometry;
}

/// Half extents of a collider that is not a plane.
Vec3f half_size(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return {sphere->radius, sphere->radius, sphere->radius};
  if (const auto* c = std::get_if<Capsule>(&shape)) return {c->radius, c->radius + c->half_length, c->radius};
  if (const auto* box = std::get_if<Box>(&shape)) return box->half_extents;
  return {};
}

bool finite(const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

[[noreturn]] void refuse(const char* kind, std::size_t index, const std::string& problem) {
  throw Error(
      {.file = {}, .line = 0, .object = {}, .element = kind + (" " + std::to_string(index)) + " of the picture"},
      problem);
}

void check_triangles(const char* kind, std::size_t index, const std::vector<Vec3f>& positions,
                     const std::vector<std::array<int, 3>>& triangles) {
  if (!std::all_of(positions.begin(), positions.end(), finite))
    refuse(kind, index, "has a vertex with a position that is not finite");
  const int count = static_cast<int>(positions.size());
  for (const auto& triangle : triangles)
    for (const int i : triangle)
      if (i < 0 || i >= count)
        refuse(kind, index, "has a triangle with vertex " + std::to_string(i) + " of " + std::to_string(count));
}

void check_mesh(const RenderMesh& mesh, std::size_t index) {
  check_triangles("mesh", index, mesh.positions, mesh.triangles);
  if (!mesh.creased.empty() && mesh.creased.size() != mesh.positions.size())
    refuse("mesh", index, "has another number of positions in its creased shape");
  if (!mesh.checks.empty() && mesh.checks.size() != mesh.positions.size())
    refuse("mesh", index, "has another number of places in its pattern");
}

void check_body(const RenderBody& body, std::size_t index) {
  if (!body.mesh) refuse("body", index, "has no mesh");
  check_triangles("body", index, body.mesh->positions, body.mesh->triangles);
  const Quatf& q = body.pose.rotation;
  if (!finite(body.pose.position) || !finite({q.x, q.y, q.z}) || !std::isfinite(q.w))
    refuse("body", index, "has a pose that is not finite");
}

}  // namespace

void Bounds::include(const Vec3f& point, float margin) {
  const Vec3f around{margin, margin, margin}, l = point - around, h = point + around;
  if (empty()) {
    low = l;
    high = h;
    return;
  }
  low = {std::min(low.x, l.x), std::min(low.y, l.y), std::min(low.z, l.z)};
  high = {std::max(high.x, h.x), std::max(high.y, h.y), std::max(high.z, h.z)};
}

void Bounds::include(const Bounds& other) {
  if (other.empty()) return;
  include(other.low);
  include(other.high);
}

float Bounds::radius() const { return empty() ? 0 : length(high - low) * 0.5f; }

Bounds bounds(const std::vector<Vec3f>& points) {
  Bounds result;
  for (const Vec3f& point : points) result.include(point);
  return result;
}

bool is_level_plane(const RenderCollider& collider) {
  return std::holds_alternative<Plane>(collider.shape) && rotate(collider.rotation, {0, 1, 0}).y > 0.99999f;
}

std::vector<Vec3f> points_of_interest(const RenderScene& scene) {
  std::vector<Vec3f> points;
  for (const RenderMesh& mesh : scene.meshes) {
    if (mesh.is_liquid)
      include_most(mesh.positions, points);
    else if (!mesh.is_solid)
      points.insert(points.end(), mesh.positions.begin(), mesh.positions.end());
  }
  std::vector<Vec3f> of_strays;
  for (const RenderTube& tube : scene.tubes) {
    std::vector<Vec3f>& into = tube.may_stray ? of_strays : points;
    into.insert(into.end(), tube.points.begin(), tube.points.end());
  }
  include_most(of_strays, points);
  for (const RenderBalls& balls : scene.balls) include_most(balls.centres, points);
  for (const RenderSmoke& smoke : scene.smokes) points.insert(points.end(), smoke.centres.begin(), smoke.centres.end());
  points.insert(points.end(), scene.unseen.begin(), scene.unseen.end());
  constexpr float any = std::numeric_limits<float>::infinity();
  const float large = 2 * usual_radius(scene);  // a ball among blades of grass is no stray
  include_most(corners_of_bodies(scene, false, -1, large), points);
  const std::vector<Vec3f> large_ones = corners_of_bodies(scene, false, large, any);
  points.insert(points.end(), large_ones.begin(), large_ones.end());
  const float size = bounds(points).radius();
  const std::vector<Vec3f> fixed = corners_of_bodies(scene, true, -1, size == 0 ? any : 2.5f * size);
  points.insert(points.end(), fixed.begin(), fixed.end());
  for (const RenderMesh& mesh : scene.meshes)
    if (mesh.is_solid && (size == 0 || bounds(mesh.positions).radius() < 2.5f * size))
      points.insert(points.end(), mesh.positions.begin(), mesh.positions.end());
  for (const RenderCollider& collider : scene.colliders) {
    const Vec3f half = half_size(collider.shape);
    const bool fits = size == 0 || length(half) < 2.5f * size;
    if (std::holds_alternative<Plane>(collider.shape) || !fits) continue;
    Geometry shape = build_collider(collider, {}, 1);
    for (const Vertex& vertex : shape.vertices) points.push_back(vertex.position);
  }
  return points;
}

Extent extent_of(const std::vector<RenderScene>& scenes) {
  Bounds all;
  for (const RenderScene& scene : scenes) all.include(bounds(points_of_interest(scene)));
  if (all.empty()) all.include({0, 0.5f, 0}, 0.5f);
  if (all.radius() < 1e-6f) all.include(all.centre(), 0.5f);
  return {all.centre(), all.radius()};
}

namespace {

/// True for a plane that the eye is behind, as the front wall of a tank.
bool hides_all(const RenderCollider& collider, const Vec3f& eye) {
  return std::holds_alternative<Plane>(collider.shape) &&
         dot(rotate(collider.rotation, {0, 1, 0}), eye - collider.position) < 0;
}

}  // namespace

std::vector<Geometry> build_geometry(const RenderScene& scene, const Vec3f& around, float radius, float least_radius,
                                     const Vec3f& eye) {
  std::vector<Geometry> result;
  for (const RenderMesh& mesh : scene.meshes) result.push_back(build_mesh(mesh));
  for (const RenderTube& tube : scene.tubes) result.push_back(build_tube(tube, least_radius));
  for (const RenderBalls& balls : scene.balls)
    if (!balls.centres.empty()) result.push_back(build_balls(balls, least_radius));
  add_bodies(scene.bodies, result);
  for (const RenderCollider& collider : scene.colliders) {
    const bool is_ground = scene.ground && is_level_plane(collider) && collider.position.y <= *scene.ground + 1e-6f;
    if (is_ground || hides_all(collider, eye)) continue;
    result.push_back(is_wall(collider) ? build_wall(collider, scene.colliders, around, radius)
                                       : build_collider(collider, around, radius));
  }
  return result;
}

Geometry build_ground(const Vec3f& centre, float half_size_, const Vec3f& colour) {
  Geometry geometry{.vertices = {}, .indices = {0, 1, 2, 0, 2, 3}, .colour = colour, .material = Material::ground};
  for (const auto& [x, z] : {std::pair{-1.f, -1.f}, {-1.f, 1.f}, {1.f, 1.f}, {1.f, -1.f}})
    geometry.vertices.push_back({centre + Vec3f{x * half_size_, 0, z * half_size_}, {0, 1, 0}});
  return geometry;
}

void check(const RenderScene& scene) {
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) check_mesh(scene.meshes[m], m);
  for (std::size_t t = 0; t < scene.tubes.size(); ++t) {
    const RenderTube& tube = scene.tubes[t];
    const bool fine = std::all_of(tube.points.begin(), tube.points.end(), finite) && std::isfinite(tube.radius) &&
                      std::all_of(tube.radii.begin(), tube.radii.end(), [](float r) { return std::isfinite(r); });
    if (!tube.radii.empty() && tube.radii.size() != tube.points.size())
      refuse("tube", t, "has another number of radii than of points");
    if (!fine) refuse("tube", t, "has a position that is not finite");
  }
  for (std::size_t b = 0; b < scene.balls.size(); ++b) {
    const std::vector<Vec3f>& centres = scene.balls[b].centres;
    if (!std::all_of(centres.begin(), centres.end(), finite) || !std::isfinite(scene.balls[b].radius))
      refuse("group of balls", b, "has a position or radius that is not finite");
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) check_body(scene.bodies[b], b);
  for (std::size_t c = 0; c < scene.colliders.size(); ++c) {
    const Quatf& q = scene.colliders[c].rotation;
    const bool fine = finite(scene.colliders[c].position) && finite({q.x, q.y, q.z}) && std::isfinite(q.w) &&
                      finite(half_size(scene.colliders[c].shape));
    if (!fine) refuse("collider", c, "has a position that is not finite");
  }
}

}  // namespace pliant::render
