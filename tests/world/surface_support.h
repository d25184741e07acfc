// What the tests of contact between surfaces share: colliding cloth, sheets to make it of, and a search for crossings.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "collision/untangle/intersections.h"
#include "world/world_support.h"

namespace pliant::testing_support {

/// Rigid cotton with self-collision that collides with other objects.
inline Object cloth(const TriangleMesh& mesh, float thickness = 0.002f) {
  ClothOptions options;
  options.material = fabric("cotton");
  options.stretch = Stiffness::rigid();
  Object object = make_cloth(mesh, options);
  object.thickness = thickness;
  object.self_collision = object.collides = true;
  return object;
}

inline Object named_cloth(const TriangleMesh& mesh, const std::string& name) {
  Object object = cloth(mesh);
  object.name = name;
  return object;
}

/// A level sheet of n x n vertices.
inline TriangleMesh sheet(int n, float size, float height) {
  TriangleMesh mesh = grid_mesh(n, n, size, size);
  for (Vec3f& p : mesh.positions) p.y += height;
  return mesh;
}

inline Scene scene_of(int substeps) {
  Scene scene;
  scene.settings = settings_of(substeps);
  return scene;
}

/// Finds the crossings among those objects of a World whose masks let them meet, and moving mesh colliders.
class Watch {
 public:
  Watch(const World& world, const Scene& scene) : scene_(scene), objects_(world.object_count()) {
    const auto add = [&](const TriangleMesh& mesh, int object) {
      const int first = static_cast<int>(object_of_.size());
      for (const auto& t : mesh.triangles) triangles_.push_back({first + t[0], first + t[1], first + t[2]});
      object_of_.insert(object_of_.end(), mesh.positions.size(), object);
    };
    for (int o = 0; o < objects_; ++o) add(world.object(o).mesh(), o);
    for (const MeshCollider& collider : scene.mesh_colliders) add(collider.mesh, objects_);
    finder_ = std::make_unique<IntersectionFinder>(triangles_, static_cast<int>(object_of_.size()));
  }

  /// `carried`: how far the mesh colliders have moved.
  std::size_t crossings(const World& world, const Vec3f& carried = {}) {
    std::vector<Vec3f> places;
    for (int o = 0; o < objects_; ++o) {
      const std::vector<Vec3f> more = world.object(o).positions();
      places.insert(places.end(), more.begin(), more.end());
    }
    for (const MeshCollider& collider : scene_.mesh_colliders)
      for (const Vec3f& p : collider.mesh.positions) places.push_back(p + carried);
    const std::vector<Intersection> found = finder_->find(places);
    return static_cast<std::size_t>(std::count_if(found.begin(), found.end(), [&](const Intersection& crossing) {
      return meet(object_of_[crossing.a], object_of_[triangles_[crossing.triangle][0]]);
    }));
  }

 private:
  bool meet(int a, int b) const {
    if (a == b || a >= objects_ || b >= objects_) return true;
    const Object &p = scene_.objects[a], &q = scene_.objects[b];
    return (p.groups & q.mask) != 0 && (q.groups & p.mask) != 0;
  }

  const Scene& scene_;
  int objects_;
  std::vector<Triangle> triangles_;
  std::vector<int> object_of_;  ///< object of each vertex; objects_ has the objects of each mesh
  std::unique_ptr<IntersectionFinder> finder_;
};

}  // namespace pliant::testing_support
