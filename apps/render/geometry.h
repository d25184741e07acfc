// A RenderScene in a form that can be drawn: triangles with normals, and their bounds.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render.h"

namespace pliant::render {

struct Vertex {
  Vec3f position, normal;
  float shade = 1;  ///< factor of the colour: less where cloth is wet
  std::array<float, 2>
      checks{};  ///< place in the pattern of cloth, one from line to line; without a pattern all are equal
};

/// How a surface is shaded.
enum class Material { cloth, solid, ground, grains, liquid, jelly };

/// True for what light passes through.
inline bool is_clear(Material material) { return material == Material::liquid || material == Material::jelly; }

/// Triangles of one colour.
struct Geometry {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
  Vec3f colour{};
  Material material = Material::solid;
  float clarity = 0;                           ///< of what is clear [m]; 0: by the size of the picture
  bool checked = false;                        ///< true: cloth with a pattern
  std::vector<std::array<float, 4>> places{};  ///< a copy is drawn at each: shift and scale; none: once, as it is
};

/// A bounding box of points. It is empty until a point is included.
struct Bounds {
  Vec3f low{1, 1, 1}, high{-1, -1, -1};

  bool empty() const { return low.x > high.x; }
  void include(const Vec3f& point, float margin = 0);
  void include(const Bounds& other);
  Vec3f centre() const { return (low + high) * 0.5f; }
  float radius() const;  ///< radius of the sphere around the box
};

/// Every point that a picture should show: surfaces, tubes, and colliders that are not much larger than these.
std::vector<Vec3f> points_of_interest(const RenderScene& scene);
Bounds bounds(const std::vector<Vec3f>& points);

/// True if the collider is a horizontal plane that faces up.
bool is_level_plane(const RenderCollider& collider);

/// Makes all geometry but the ground. A plane becomes a slab of half size `radius` about `around`; tubes have at least
/// `least_radius`. Planes that the eye is behind are left out, since they would hide all.
std::vector<Geometry> build_geometry(const RenderScene& scene, const Vec3f& around, float radius, float least_radius,
                                     const Vec3f& eye);

/// Makes a horizontal square with the given centre.
Geometry build_ground(const Vec3f& centre, float half_size, const Vec3f& colour);

/// Throws an Error that names mesh and element if a position is not finite or an index is out of range.
void check(const RenderScene& scene);

}  // namespace pliant::render
