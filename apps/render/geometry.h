// The drawable form of a RenderScene: triangles with normals, and their bounds.
#pragma once

#include <cstdint>
#include <vector>

#include "render.h"

namespace pliant::render {

struct Vertex {
  Vec3f position, normal;
};

/// The shading model of a surface.
enum class Material { cloth, solid, ground };

/// Triangles of one colour.
struct Geometry {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  Vec3f colour{};
  Material material = Material::solid;
};

/// A bounding box of points; empty until one is included.
struct Bounds {
  Vec3f low{1, 1, 1}, high{-1, -1, -1};

  bool empty() const { return low.x > high.x; }
  void include(const Vec3f& point, float margin = 0);
  void include(const Bounds& other);
  Vec3f centre() const { return (low + high) * 0.5f; }
  float radius() const;  ///< radius of the box's circumscribed sphere
};

/// Every point that a picture should show: surfaces, tubes, and colliders not much larger than those.
std::vector<Vec3f> points_of_interest(const RenderScene& scene);
Bounds bounds(const std::vector<Vec3f>& points);

/// True if the collider is a horizontal plane that faces up.
bool is_level_plane(const RenderCollider& collider);

/// All geometry except the ground. `around` and `radius` give the extent
/// of a plane's slab; tubes have a radius of at least `least_radius`.
std::vector<Geometry> build_geometry(const RenderScene& scene, const Vec3f& around, float radius, float least_radius);

/// A horizontal square about `centre`.
Geometry build_ground(const Vec3f& centre, float half_size, const Vec3f& colour);

/// Throws an Error that names mesh and element if a position is not finite or an index is out of range.
void check(const RenderScene& scene);

}  // namespace pliant::render
