// Tests what of a Scene and a World is drawn, and at which height the ground is.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "pliant/body.h"
#include "pliant/cluster.h"
#include "pliant/grains.h"
#include "pliant/soft_body.h"
#include "pliant/surface.h"
#include "render/render.h"

namespace pliant::render {
namespace {

TEST(SceneView, TakesSurfacesRopesAndColliders) {
  Scene scene;
  scene.add_cloth(grid_mesh(4, 3, 1, 1));
  scene.objects[0].colour = {0.1f, 0.2f, 0.3f};
  const int rope = scene.add(make_rope({{0, 1, 0}, {0.1f, 1, 0}, {0.2f, 1, 0}}));
  Collider ball;
  ball.shape = Sphere{0.3f};
  ball.position = {2, 0.3f, 0};
  scene.add(ball);
  World world(scene);
  world.step(1.f / 60);
  const RenderScene picture = make_render_scene(scene, world);
  ASSERT_EQ(picture.meshes.size(), 1u);
  EXPECT_EQ(picture.meshes[0].positions, world.object(0).positions());
  EXPECT_EQ(picture.meshes[0].triangles, scene.objects[0].triangles);
  EXPECT_EQ(picture.meshes[0].colour, (Vec3f{0.1f, 0.2f, 0.3f}));
  ASSERT_EQ(picture.tubes.size(), 1u);
  EXPECT_EQ(picture.tubes[0].points, world.object(rope).positions());
  EXPECT_FLOAT_EQ(picture.tubes[0].radius, scene.objects[1].thickness);
  ASSERT_EQ(picture.colliders.size(), 1u);
  EXPECT_EQ(picture.colliders[0].position, (Vec3f{2, 0.3f, 0}));
}

TEST(SceneView, ShowsMeshCollidersWhereTheyAre) {
  Scene scene;
  scene.add_cloth(grid_mesh(4, 3, 1, 1));
  MeshCollider rock;
  rock.mesh = sphere_mesh(1);
  for (Vec3f& p : rock.mesh.positions) p.y -= 3;
  rock.motion.keyframes = {{0, {}, {}}, {1, {1, 0, 0}, {}}};
  rock.colour = {0.1f, 0.4f, 0.1f};
  scene.add(rock);
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) world.step(1.f / 60);
  const RenderScene picture = make_render_scene(scene, world);
  ASSERT_EQ(picture.meshes.size(), 2u);
  EXPECT_FALSE(picture.meshes[0].is_solid);
  EXPECT_TRUE(picture.meshes[1].is_solid);
  EXPECT_EQ(picture.meshes[1].colour, rock.colour);
  EXPECT_EQ(picture.meshes[1].triangles, rock.mesh.triangles);
  EXPECT_NEAR(picture.meshes[1].positions[0].x, rock.mesh.positions[0].x + 0.5f, 1e-5f);
  EXPECT_LT(picture.ground.value_or(0), -4) << "the ground is below what cloth falls on";
}

TEST(SceneView, ShowsBodiesAsTheirSolids) {
  Object pile;
  pile.name = "pile";
  pile.colour = {0.5f, 0.25f, 0.125f};
  BodyOptions options;
  options.angular_velocity = {0, 6, 0};
  for (int i = 0; i < 3; ++i) {
    options.position = {static_cast<float>(2 * i), 3, 0};
    if (i == 2) options.mass = std::numeric_limits<float>::infinity();
    add_body(pile, {{Box{}}}, options);
  }
  Scene scene;
  scene.add(pile);
  World world(scene);
  for (int frame = 0; frame < 10; ++frame) world.step(1.f / 60);
  const RenderScene picture = make_render_scene(scene, world);
  EXPECT_TRUE(picture.tubes.empty()) << "the centres of bodies are no balls";
  ASSERT_EQ(picture.bodies.size(), 3u);
  EXPECT_EQ(picture.bodies[0].mesh, picture.bodies[1].mesh);
  EXPECT_EQ(picture.bodies[0].pose.position, world.object(0).positions()[0]);
  EXPECT_LT(picture.bodies[0].pose.position.y, 3) << "nothing fell";
  EXPECT_EQ(picture.bodies[1].pose.rotation, world.object(0).orientations()[1]);
  EXPECT_FALSE(picture.bodies[1].pose.rotation == picture.bodies[2].pose.rotation) << "nothing spun";
  EXPECT_EQ(picture.bodies[0].colour, (Vec3f{0.5f, 0.25f, 0.125f}));
  EXPECT_FALSE(picture.bodies[0].colour == picture.bodies[1].colour) << "a pile can be read";
  EXPECT_FALSE(picture.bodies[1].is_fixed);
  EXPECT_TRUE(picture.bodies[2].is_fixed);
  scene.objects[0].positions[2].y = -4;
  EXPECT_LT(make_render_scene(scene, World(scene)).ground.value_or(0), -4.5f) << "the ground is below the lowest solid";
}

TEST(SceneView, ShowsWhatIsHeavyAsABall) {
  Scene scene;
  scene.add(make_rope({{0, 1, 0}, {0.1f, 1, 0}, {0.2f, 1, 0}, {0.3f, 1, 0}}));
  ASSERT_EQ(make_render_scene(scene, World(scene)).tubes.size(), 1u) << "the halved ends of a rope are no weights";
  scene.objects[0].masses[3] = 8 * scene.objects[0].masses[1];
  const RenderScene picture = make_render_scene(scene, World(scene));
  ASSERT_EQ(picture.tubes.size(), 2u);
  EXPECT_EQ(picture.tubes[1].points, std::vector<Vec3f>{scene.objects[0].positions[3]});
  EXPECT_FLOAT_EQ(picture.tubes[1].radius, 2 * 2 * scene.objects[0].thickness) << "cube root of 8";
}

TEST(SceneView, ShowsFreeParticlesAsBalls) {
  Scene scene;
  Object object;
  object.positions = {{0, 1, 0}, {0.1f, 1, 0}, {0.5f, 2, 0}};
  object.masses = {1, 1, 1};
  object.thickness = 0.02f;
  scene.add(object);
  const RenderScene picture = make_render_scene(scene, World(scene));
  ASSERT_EQ(picture.balls.size(), 1u);
  EXPECT_TRUE(picture.tubes.empty());
  EXPECT_EQ(picture.balls[0].centres, object.positions);
  EXPECT_EQ(picture.balls[0].radius, object.thickness);
  const Extent extent = extent_of({picture});
  EXPECT_NEAR(extent.centre.x, 0.25f, 1e-5f);
}

std::vector<Vec3f> lattice(int side, float spacing) {
  std::vector<Vec3f> places;
  for (int i = 0; i < side * side * side; ++i)
    places.push_back(Vec3f{static_cast<float>(i % side), static_cast<float>(i / side % side) + 1,
                           static_cast<float>(i / side / side)} *
                     spacing);
  return places;
}

TEST(SceneView, ShowsGrainsAsGrainsAndThoseThatKeepAShapeAsASurface) {
  Scene scene;
  scene.add(make_grains(lattice(4, 0.02f)));
  RenderScene picture = make_render_scene(scene, World(scene));
  ASSERT_EQ(picture.balls.size(), 1u);
  EXPECT_TRUE(picture.balls[0].are_grains);
  scene.objects[0].clarity = 0.03f;
  add_clusters(scene.objects[0], 1);
  picture = make_render_scene(scene, World(scene));
  EXPECT_TRUE(picture.balls.empty());
  ASSERT_EQ(picture.meshes.size(), 1u);
  EXPECT_FALSE(picture.meshes[0].is_liquid);
  EXPECT_EQ(picture.meshes[0].clarity, 0.03f);
  scene.objects[0].clusters[0].particles.pop_back();
  EXPECT_EQ(make_render_scene(scene, World(scene)).balls.size(), 1u) << "one grain is loose";
}

TEST(SceneView, GivesFlatSheetsChecksAndNoOtherSurfaces) {
  Scene scene;
  scene.add_cloth(grid_mesh(4, 2, 8, 4));
  scene.add_cloth(sphere_mesh(2));
  scene.objects[0].clarity = 0.1f;
  const RenderScene picture = make_render_scene(scene, World(scene));
  ASSERT_EQ(picture.meshes.size(), 2u);
  ASSERT_EQ(picture.meshes[0].checks.size(), picture.meshes[0].positions.size());
  float most[2] = {0, 0};
  for (const auto& place : picture.meshes[0].checks)
    for (std::size_t k = 0; k < 2; ++k) most[k] = std::max(most[k], place[k]);
  EXPECT_NEAR(most[0], 2 * most[1], 1e-3f) << "checks are squares";
  EXPECT_TRUE(picture.meshes[1].checks.empty());
  EXPECT_EQ(picture.meshes[0].clarity, 0) << "an open sheet has no inside";
}

TEST(SceneView, ShowsALiquidAsItsSurface) {
  Scene scene;
  Object object;
  for (int i = 0; i < 64; ++i)
    object.positions.push_back(
        Vec3f{static_cast<float>(i & 3), static_cast<float>(i >> 2 & 3), static_cast<float>(i >> 4)} * 0.1f);
  object.masses.assign(64, 1);
  object.fluid = Fluid{.spacing = 0.1f};
  scene.add(object);
  const RenderScene picture = make_render_scene(scene, World(scene));
  ASSERT_EQ(picture.meshes.size(), 1u);
  EXPECT_TRUE(picture.balls.empty());
  EXPECT_TRUE(picture.meshes[0].is_liquid);
  const TriangleMesh expected = liquid_surface(object.positions, {.spacing = 0.1f});
  EXPECT_EQ(picture.meshes[0].positions, expected.positions);
  EXPECT_EQ(picture.meshes[0].triangles, expected.triangles);
}

TEST(SceneView, GivesSolidsTheEdgesOfTheirShapeAndClothNone) {
  Scene scene;
  scene.add(make_soft_body({{{0, 1, 0}, {1, 1, 0}, {0, 2, 0}, {0, 1, 1}}, {{0, 1, 2, 3}}}));
  scene.add_cloth(grid_mesh(4, 3, 1, 1));
  World world(scene);
  world.step(1.f / 60);
  const RenderScene picture = make_render_scene(scene, world);
  ASSERT_EQ(picture.meshes.size(), 2u);
  EXPECT_EQ(picture.meshes[0].creased, scene.objects[0].positions);
  EXPECT_TRUE(picture.meshes[1].creased.empty());
}

TEST(SceneView, PutsTheGroundUnderEverything) {
  const auto ground = [](const Scene& scene) { return make_render_scene(scene, World(scene)).ground.value_or(1e9f); };
  Scene scene;
  scene.add_cloth(grid_mesh(4, 3, 1, 1));
  EXPECT_EQ(ground(scene), 0) << "what lies at 0 lies on the ground";
  for (Vec3f& position : scene.objects[0].positions) position.y -= 2;
  EXPECT_LT(ground(scene), -2);
  Collider floor;
  floor.position = {0, -3, 0};
  scene.add(floor);
  EXPECT_EQ(ground(scene), -3) << "a level plane is the ground";
}

TEST(SceneView, KeepsTheGroundStillWhileThingsSwing) {
  Scene scene;
  scene.settings.threads = 1;
  scene.add_cloth(grid_mesh(8, 8, 1, 1));
  scene.pin(0, {0, 7});
  World world(scene);
  const float before = *make_render_scene(scene, world).ground;
  for (int frame = 0; frame < 60; ++frame) world.step(1.f / 60);
  const RenderScene after = make_render_scene(scene, world);
  EXPECT_EQ(*after.ground, before);
  for (const Vec3f& position : after.meshes[0].positions) EXPECT_GT(position.y, before);
}

}  // namespace
}  // namespace pliant::render
