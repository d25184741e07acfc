// Solids and surfaces for tests of bodies that slide, pass by and are shot.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/scene.h"

namespace pliant::testing_support {

inline constexpr float half_root = 0.70710678f;

inline Hull octahedron(float radius) {
  return {{{radius, 0, 0}, {-radius, 0, 0}, {0, radius, 0}, {0, -radius, 0}, {0, 0, radius}, {0, 0, -radius}}, 0};
}

/// A prism of eight sides that stands.
inline Hull prism(float radius, float half_height) {
  Hull hull;
  for (const float y : {-half_height, half_height})
    for (const Vec3f& p :
         {Vec3f{1, y, 0}, Vec3f{half_root, y, half_root}, Vec3f{0, y, 1}, Vec3f{-half_root, y, half_root},
          Vec3f{-1, y, 0}, Vec3f{-half_root, y, -half_root}, Vec3f{0, y, -1}, Vec3f{half_root, y, -half_root}})
      hull.points.push_back({radius * p.x, p.y, radius * p.z});
  return hull;
}

inline Collider block(const Vec3f& centre, const Vec3f& half) {
  Collider box;
  box.shape = Box{half};
  box.position = centre;
  box.static_friction = box.kinetic_friction = 0;
  return box;
}

inline MeshCollider mesh_block(const Vec3f& centre, const Vec3f& half) {
  MeshCollider box;
  box.mesh = mesh_of({{Box{half}}});
  for (Vec3f& p : box.mesh.positions) p += centre;
  box.static_friction = box.kinetic_friction = 0;
  return box;
}

inline void lay_fixed_body(Scene& scene, const std::vector<Solid>& solids, const Vec3f& position) {
  BodyOptions options;
  options.mass = INFINITY;
  options.position = position;
  Object object = make_body(solids, options);
  object.name = "floor " + std::to_string(scene.objects.size());
  object.static_friction = object.kinetic_friction = 0;
  scene.objects.push_back(object);
}

/// A flat grid of cells of a width, about the origin.
inline MeshCollider grid(int cells, float width) {
  MeshCollider out;
  for (int z = 0; z <= cells; ++z)
    for (int x = 0; x <= cells; ++x)
      out.mesh.positions.push_back({width * (static_cast<float>(x) - 0.5f * static_cast<float>(cells)), 0,
                                    width * (static_cast<float>(z) - 0.5f * static_cast<float>(cells))});
  for (int z = 0; z < cells; ++z)
    for (int x = 0; x < cells; ++x) {
      const int at = z * (cells + 1) + x;
      out.mesh.triangles.push_back({at, at + cells + 1, at + 1});
      out.mesh.triangles.push_back({at + 1, at + cells + 1, at + cells + 2});
    }
  return out;
}

}  // namespace pliant::testing_support
