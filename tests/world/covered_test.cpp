// Tests that cloth that falls on falling bodies does not pass through them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "geometry/exact.h"
#include "math/quat.h"
#include "pliant/body.h"
#include "pliant/mesh.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// A mesh in the world.
struct Placed {
  std::vector<Vec3f> positions;
  std::vector<std::array<int, 3>> triangles;
};

struct Bounds {
  Vec3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};

  void add(const Vec3f& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  bool meets(const Bounds& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y && low.z <= b.high.z &&
           b.low.z <= high.z;
  }
};

Bounds bounds_of(const Placed& mesh, const std::array<int, 3>& triangle) {
  Bounds bounds;
  for (const int i : triangle) bounds.add(mesh.positions[static_cast<std::size_t>(i)]);
  return bounds;
}

/// Edges of `a` through triangles of `b`, by exact signs. Every edge of a closed mesh is an edge of two triangles and counts twice.
int edges_through(const Placed& a, const Placed& b) {
  Bounds of_b;
  for (const Vec3f& p : b.positions) of_b.add(p);
  int count = 0;
  for (const std::array<int, 3>& t : a.triangles) {
    const Bounds own = bounds_of(a, t);
    if (!own.meets(of_b)) continue;
    for (const std::array<int, 3>& u : b.triangles) {
      if (!own.meets(bounds_of(b, u))) continue;
      const auto at = [&](int i) { return b.positions[static_cast<std::size_t>(i)]; };
      for (std::size_t i = 0; i < 3; ++i)
        if (edge_crosses_triangle(a.positions[static_cast<std::size_t>(t[i])],
                                  a.positions[static_cast<std::size_t>(t[(i + 1) % 3])], at(u[0]), at(u[1]), at(u[2])))
          ++count;
    }
  }
  return count;
}

/// A level cloth of n x n vertices over k x 2 x k boxes and two balls, all in the air above the ground.
Scene covered(int n, float side, int k) {
  Scene scene;
  scene.colliders.emplace_back();
  Object cloth = make_cloth(grid_mesh(n, n, side, side), {.material = fabric("cotton")});
  for (Vec3f& p : cloth.positions) p.y = 0.9f;
  cloth.thickness = 0.004f;
  cloth.collides = cloth.self_collision = true;
  scene.add(cloth);
  Object heap;
  BodyOptions options;
  const float first = -0.12f * static_cast<float>(k - 1);
  for (int i = 0; i < 2 * k * k; ++i) {
    options.position = {first + 0.24f * static_cast<float>(i % k), i % 2 == 0 ? 0.14f : 0.38f,
                        first + 0.24f * static_cast<float>(i / 2 / k)};
    if (i / (k * k) == 1) options.position.y += 0.24f;
    options.rotation =
        rotation({1, static_cast<float>(i % 5), static_cast<float>(i % 3)}, static_cast<float>(37 * i % 360));
    add_body(heap, {{.shape = Box{{0.07f, 0.05f, 0.06f}}, .density = 500}}, options);
  }
  scene.add(heap);
  return scene;
}

int crossings(const World& world, const Object& cloth, const Object& heap) {
  const Placed sheet{world.object(0).positions(), cloth.triangles};
  const std::vector<Vec3f> places = world.object(1).positions();
  const std::vector<Quatf> turns = world.object(1).orientations();
  int count = 0;
  for (const ObjectBody& body : heap.bodies) {
    const TriangleMesh own = mesh_of(body.solids);
    Placed mesh{own.positions, own.triangles};
    for (Vec3f& p : mesh.positions)
      p = places[static_cast<std::size_t>(body.particle)] + rotate(turns[static_cast<std::size_t>(body.frame)], p);
    count += edges_through(sheet, mesh) + edges_through(mesh, sheet);
  }
  return count;
}

int worst_crossings(const Scene& scene, int frames) {
  World world(scene);
  int worst = 0;
  for (int frame = 0; frame < frames; ++frame) {
    EXPECT_TRUE(world.step(1.f / 60).ok());
    worst = std::max(worst, crossings(world, scene.objects[0], scene.objects[1]));
  }
  return worst;
}

TEST(CoveredBodies, NoEdgeOfTheClothPassesThroughABody) { EXPECT_EQ(worst_crossings(covered(30, 0.9f, 3), 120), 0); }

TEST(CoveredBodies, TheCountSeesClothWithoutContact) {
  Scene scene = covered(30, 0.9f, 3);
  scene.objects[0].collides = false;
  EXPECT_GT(worst_crossings(scene, 40), 0);
}

}  // namespace
}  // namespace pliant
