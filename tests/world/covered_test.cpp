// Tests that cloth that falls on falling bodies does not pass through them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
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

struct MeshBounds {
  Vec3f low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};

  void add(const Vec3f& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  bool meets(const MeshBounds& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y && low.z <= b.high.z &&
           b.low.z <= high.z;
  }
};

MeshBounds bounds_of(const Placed& mesh, const std::array<int, 3>& triangle) {
  MeshBounds bounds;
  for (const int i : triangle) bounds.add(mesh.positions[static_cast<std::size_t>(i)]);
  return bounds;
}

/// Edges of `a` through triangles of `b`, by exact signs. Every edge of a closed mesh is an edge of two triangles and
/// counts twice.
int edges_through(const Placed& a, const Placed& b) {
  MeshBounds of_b;
  for (const Vec3f& p : b.positions) of_b.add(p);
  std::vector<MeshBounds> of_triangles;
  for (const std::array<int, 3>& u : b.triangles) of_triangles.push_back(bounds_of(b, u));
  int count = 0;
  for (const std::array<int, 3>& t : a.triangles) {
    const MeshBounds own = bounds_of(a, t);
    if (!own.meets(of_b)) continue;
    for (std::size_t k = 0; k < b.triangles.size(); ++k) {
      if (!own.meets(of_triangles[k])) continue;
      const std::array<int, 3>& u = b.triangles[k];
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

/// A level cloth of 30 x 30 vertices over 18 bodies of six shapes, all in the air above the ground.
Scene covered_mixed() {
  Scene scene = covered(30, 0.9f, 3);
  const std::vector<Vec3f> corners{
      {.08f, 0, 0}, {-.06f, .03f, 0}, {0, .07f, .02f}, {0, -.05f, .05f}, {.01f, -.03f, -.07f}};
  const std::vector<SolidShape> shapes{Box{{.07f, .05f, .06f}}, Sphere{.07f},     Capsule{.05f, .06f},
                                       Cylinder{.06f, .06f},    Cone{.07f, .07f}, Hull{corners}};
  const Object boxes = scene.objects[1];
  Object heap;
  heap.name = "heap";
  for (int i = 0; i < static_cast<int>(boxes.bodies.size()); ++i) {
    BodyOptions options;
    options.position = boxes.positions[static_cast<std::size_t>(boxes.bodies[static_cast<std::size_t>(i)].particle)];
    options.rotation =
        rotation({1, static_cast<float>(i % 5), static_cast<float>(i % 3)}, static_cast<float>(37 * i % 360));
    add_body(heap, {{.shape = shapes[static_cast<std::size_t>(i + i / 6) % shapes.size()], .density = 500}}, options);
  }
  scene.objects[1] = heap;
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

TEST(CoveredBodies, NoEdgePassesThroughBodiesOfAnyShape) { EXPECT_EQ(worst_crossings(covered_mixed(), 300), 0); }

/// A body that is thrown at cloth whose border is pinned.
Scene thrown(const SolidShape& shape, float speed, bool pinned) {
  Scene scene;
  scene.gravity = {};
  Object cloth = make_cloth(grid_mesh(21, 21, 1, 1), {.material = fabric("cotton")});
  cloth.thickness = 0.004f;
  cloth.collides = true;
  for (std::size_t i = 0; i < cloth.positions.size(); ++i) {
    const bool is_border = i % 21 == 0 || i % 21 == 20 || i < 21 || i >= 20 * 21;
    if (pinned && is_border) cloth.pins.push_back({static_cast<int>(i), {}});
  }
  Vec3f middle{};
  for (const Vec3f& p : cloth.positions) middle += p * (1.f / static_cast<float>(cloth.positions.size()));
  for (Vec3f& p : cloth.positions) p += Vec3f{0.013f, 0, 0.021f} - middle;  // the body meets no vertex
  scene.add(cloth);
  BodyOptions options;
  options.position = {0, 0.3f, 0};
  options.rotation = rotation({1, 0, 0}, 180);  // tips point down
  options.velocity = {0, -speed, 0};
  options.angular_velocity = {0, 5, 3};
  scene.add(make_body({{shape}}, options));
  return scene;
}

TEST(CoveredBodies, AFastTipDoesNotPierceAPinnedCloth) {
  for (const float speed : {2.f, 8.f, 20.f}) {
    EXPECT_EQ(worst_crossings(thrown(Cone{0.05f, 0.06f}, speed, true), 60), 0) << speed << " m/s";
    EXPECT_EQ(worst_crossings(thrown(Box{{0.04f, 0.06f, 0.05f}}, speed, true), 60), 0) << speed << " m/s";
  }
}

/// The path of a substep may be many times the body's size.
TEST(CoveredBodies, AFastBodyDoesNotPassInAFewSubsteps) {
  for (const int substeps : {1, 4}) {
    for (const SolidShape& shape :
         std::vector<SolidShape>{Sphere{0.04f}, Box{{0.04f, 0.06f, 0.05f}}, Cone{0.05f, 0.06f}}) {
      Scene scene = thrown(shape, 30, true);
      scene.settings.substeps = substeps;
      EXPECT_EQ(worst_crossings(scene, 20), 0) << substeps << " substeps, shape " << shape.index();
      World world(scene);
      for (int frame = 0; frame < 3; ++frame) world.step(1.f / 60);
      float lowest = 0;
      for (const Vec3f& p : world.object(0).positions()) lowest = std::min(lowest, p.y);
      EXPECT_GT(world.object(1).positions()[0].y, lowest - 0.06f) << substeps << " substeps, shape " << shape.index();
    }
  }
}

TEST(CoveredBodies, HaveTheSameBitsOnAnyNumberOfThreads) {
  std::string hash;
  for (const int threads : {1, 2, 5}) {
    Scene scene = covered_mixed();
    scene.settings.threads = threads;
    World world(scene);
    for (int frame = 0; frame < 30; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
    const std::string now = world.state_hash();
    EXPECT_TRUE(hash.empty() || hash == now) << threads << " threads";
    hash = now;
  }
}

TEST(CoveredBodies, GoOnWithTheSameBitsAfterARestore) {
  World world(covered_mixed()), other(covered_mixed());
  for (int frame = 0; frame < 20; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
  other.restore(world.state());
  for (int frame = 0; frame < 10; ++frame) {
    ASSERT_TRUE(world.step(1.f / 60).ok() && other.step(1.f / 60).ok());
    EXPECT_EQ(world.state_hash(), other.state_hash()) << frame;
  }
}

/// Both together keep their momentum, to 1e-5 of the body's.
TEST(CoveredBodies, ATipThatIsKeptFromPiercingFreeClothKeepsTheMomentum) {
  const Scene scene = thrown(Cone{0.05f, 0.06f}, 5, false);
  World world(scene);
  const auto momentum = [&] {
    Vec3d sum{};
    const State& state = world.state();
    for (std::size_t i = 0; i < state.positions.size(); ++i)
      if (state.positions[i].w > 0)
        sum += Vec3d{state.velocities[i].x, state.velocities[i].y, state.velocities[i].z} * (1. / state.positions[i].w);
    return sum;
  };
  const Vec3d before = momentum();
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_TRUE(world.step(1.f / 60).ok());
    EXPECT_EQ(crossings(world, scene.objects[0], scene.objects[1]), 0) << frame;
    EXPECT_NEAR(std::sqrt(length_squared(momentum() - before)), 0, 1e-5 * std::sqrt(length_squared(before))) << frame;
  }
}

/// A kinematic press: cloth between a falling heavy body and the ground is flat, and neither passes it unless the
/// Report says so.
TEST(CoveredBodies, ClothUnderAHeavyBodyIsNotPassedUnnamed) {
  Scene scene;
  scene.colliders.emplace_back();
  Object cloth = make_cloth(grid_mesh(15, 15, 0.6f, 0.6f), {.material = fabric("cotton")});
  cloth.name = "cloth";
  for (Vec3f& p : cloth.positions) p.y = 0.01f;
  cloth.thickness = 0.004f;
  cloth.collides = true;
  scene.add(cloth);
  Object heap;
  heap.name = "heap";
  BodyOptions options;
  options.position = {0.03f, 0.3f, 0.02f};
  options.mass = 50;
  add_body(heap, {{.shape = Box{{0.1f, 0.1f, 0.1f}}}}, options);
  options.position.y = 0.6f;
  add_body(heap, {{.shape = Box{{0.1f, 0.1f, 0.1f}}}}, options);
  scene.add(heap);
  World world(scene);
  for (int frame = 0; frame < 120; ++frame) {
    const Report report = world.step(1.f / 60);
    ASSERT_TRUE(report.ok());
    const bool is_named = std::any_of(report.warnings.begin(), report.warnings.end(), [](const std::string& text) {
      return text.find("'cloth'") != std::string::npos && text.find("body 0 of 'heap'") != std::string::npos;
    });
    EXPECT_TRUE(is_named || crossings(world, scene.objects[0], scene.objects[1]) == 0) << frame;
  }
}

/// A box that is in a cloth from the start, all of whose vertices are pinned, so that only the box can give way.
TEST(CoveredBodies, ClothThatABodyOverlapsIsNamed) {
  Scene scene = thrown(Box{{0.06f, 0.06f, 0.06f}}, 0, true);
  scene.objects[0].name = "cloth";
  scene.objects[0].pins.clear();
  for (int i = 0; i < 21 * 21; ++i) scene.objects[0].pins.push_back({i, {}});
  Object heap;
  heap.name = "heap";
  BodyOptions options;
  options.position = {0, 0.01f, 0};
  add_body(heap, {{.shape = Box{{0.06f, 0.06f, 0.06f}}}}, options);
  scene.objects[1] = heap;
  World world(scene);
  const Report report = world.step(1.f / 60);
  ASSERT_GT(crossings(world, scene.objects[0], scene.objects[1]), 0);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_EQ(report.warnings[0].find("object 'cloth' passes through body 0 of 'heap' in "), 0u) << report.warnings[0];
  EXPECT_NE(report.warnings[0].find(": the vertex is pinned"), std::string::npos) << report.warnings[0];
}

/// Where nothing presses from the other side and nothing is pinned, it is no pinch: the cloth started inside. A body
/// with a name is called by it.
TEST(CoveredBodies, ABodyInLooseClothIsNotCalledPinched) {
  Scene scene = thrown(Box{{0.06f, 0.06f, 0.06f}}, 0, false);
  scene.settings.substeps = 1;
  scene.objects[0].name = "cloth";
  scene.objects[1] = make_body({{Box{{0.06f, 0.06f, 0.06f}}}}, {.name = "bullet", .position = {0, 0.01f, 0}});
  World world(scene);
  const Report report = world.step(1.f / 60);
  ASSERT_EQ(report.warnings.size(), 1u);
  const std::string& text = report.warnings[0];
  EXPECT_NE(text.find(" is inside of body 0 ('bullet') of 'bullet'"), std::string::npos) << text;
  EXPECT_NE(text.find(": it started there or was teleported there"), std::string::npos) << text;
}

TEST(CoveredBodies, TheCountSeesClothWithoutContact) {
  Scene scene = covered(30, 0.9f, 3);
  scene.objects[0].collides = false;
  EXPECT_GT(worst_crossings(scene, 40), 0);
}

}  // namespace
}  // namespace pliant
