// Makes the triangles of steep planes.
#include "walls.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <variant>

#include "matrix.h"

namespace pliant::render {

namespace {

Vec3f normal_of(const RenderCollider& plane) { return rotate(plane.rotation, {0, 1, 0}); }

/// The part of a polygon in which `normal` . p is at least `offset` (Sutherland and Hodgman 1974).
std::vector<Vec3f> clipped(const std::vector<Vec3f>& polygon, const Vec3f& normal, float offset) {
  std::vector<Vec3f> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3f &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const float at_a = dot(normal, a) - offset, at_b = dot(normal, b) - offset;
    if (at_a >= 0) result.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) result.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  return result;
}

/// Adds a flat polygon, counter-clockwise seen from where `normal` points.
void add_polygon(Geometry& geometry, const std::vector<Vec3f>& corners, const Vec3f& normal) {
  const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
  for (const Vec3f& corner : corners) geometry.vertices.push_back({corner, normal});
  for (std::uint32_t i = 2; i < corners.size(); ++i)
    geometry.indices.insert(geometry.indices.end(), {first, first + i - 1, first + i});
}

/// Adds what lies between a polygon and its copy that is moved by `depth` against its normal.
void add_prism(Geometry& geometry, const std::vector<Vec3f>& front, const Vec3f& normal, float depth) {
  const Vec3f back = normal * -depth;
  std::vector<Vec3f> rear;
  for (auto corner = front.rbegin(); corner != front.rend(); ++corner) rear.push_back(*corner + back);
  add_polygon(geometry, front, normal);
  add_polygon(geometry, rear, -normal);
  for (std::size_t i = 0; i < front.size(); ++i) {
    const Vec3f &a = front[i], &b = front[(i + 1) % front.size()];
    add_polygon(geometry, {b, a, a + back, b + back}, unit(cross(b - a, normal)));
  }
}

/// True if a plane that faces down lies below `height`.
bool has_ceiling(const std::vector<RenderCollider>& colliders, float height) {
  return std::any_of(colliders.begin(), colliders.end(), [&](const RenderCollider& collider) {
    return std::holds_alternative<Plane>(collider.shape) && normal_of(collider).y < -0.5f &&
           collider.position.y < height;
  });
}

}  // namespace

bool is_wall(const RenderCollider& collider) {
  return std::holds_alternative<Plane>(collider.shape) && std::abs(normal_of(collider).y) < 0.5f;
}

Geometry build_wall(const RenderCollider& wall, const std::vector<RenderCollider>& colliders, const Vec3f& around,
                    float radius) {
  constexpr float reach = 1.25f, above = 0.55f, thickness = 0.02f;  // shares of the radius
  constexpr float alike = 0.95f;                                    // planes of such directions do not bound each other
  const float depth = thickness * radius, half = reach * radius;
  const Vec3f normal = normal_of(wall);
  const Vec3f u = rotate(wall.rotation, {1, 0, 0}) * half, v = rotate(wall.rotation, {0, 0, 1}) * half;
  const Vec3f middle = around - normal * dot(normal, around - wall.position);
  std::vector<Vec3f> outline{middle - u - v, middle - u + v, middle + u + v, middle + u - v};
  if (!has_ceiling(colliders, around.y + half)) outline = clipped(outline, {0, -1, 0}, -(around.y + above * radius));
  for (const RenderCollider& other : colliders) {
    if (!std::holds_alternative<Plane>(other.shape)) continue;
    const Vec3f facing = normal_of(other);
    // Walls overlap by their thickness, so that there is no gap at the edge.
    if (std::abs(dot(facing, normal)) < alike) outline = clipped(outline, facing, dot(facing, other.position) - depth);
  }
  Geometry geometry{.vertices = {}, .indices = {}, .colour = wall.colour, .material = Material::solid};
  if (outline.size() > 2) add_prism(geometry, outline, normal, depth);
  return geometry;
}

}  // namespace pliant::render
