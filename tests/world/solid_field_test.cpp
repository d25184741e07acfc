// Tests solids given by a distance function: a ball's grid compared with the ball, terrain with its planes, and Worlds
// with either.
#include "collision/fields/solid_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/vector.h"
#include "pliant/error.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

MeshCollider ball(int subdivisions, float radius) {
  MeshCollider collider;
  collider.name = "ball";
  collider.mesh = sphere_mesh(subdivisions);
  for (Vec3f& p : collider.mesh.positions) p = p * radius;
  collider.as = MeshCollider::As::distance_grid;
  return collider;
}

/// Terrain that rises by a third of x.
MeshCollider ramp() {
  MeshCollider collider;
  collider.name = "ramp";
  collider.mesh = grid_mesh(9, 7, 4, 3);
  for (Vec3f& p : collider.mesh.positions) p.y = p.x / 3;
  collider.as = MeshCollider::As::heightfield;
  return collider;
}

TEST(SolidField, OfAGridIsHitWhereTheBallIs) {
  const SolidField field(DistanceGrid(measure_distances(sphere_mesh(3), 0.06f)));
  for (int i = 0; i < 200; ++i) {
    const float a = 2.39996f * static_cast<float>(i), y = 1 - (2 * static_cast<float>(i) + 1) / 200,
                r = std::sqrt(1 - y * y);
    const Vec3f out{r * std::cos(a), y, r * std::sin(a)};
    const FirstHit<float> hit = field.first_hit(3.f * out, -3.f * out, 0.1f);
    ASSERT_TRUE(hit.hit);
    EXPECT_NEAR(length(hit.point), 1.1f, 0.015f);
    EXPECT_GT(dot(hit.normal, out), 0.98f);
    EXPECT_FALSE(field.first_hit(3.f * out, 1.2f * out, 0.1f).hit);
    EXPECT_NEAR(field.distance(1.05f * out).distance, 0.05f, 0.01f);
    EXPECT_NEAR(field.distance(0.9f * out).distance, -0.1f, 0.01f);
  }
}

TEST(SolidField, OfGroundIsItsPlane) {
  const SolidField field(heightfield_of(ramp().mesh));
  const Vec3f normal = Vec3f{-1.f / 3, 1, 0} * (1 / std::sqrt(1 + 1.f / 9));
  for (const Vec3f& p : {Vec3f{0.3f, 1, 0.2f}, {-1.9f, -2, 1.4f}, {2, 0, -1.5f}, {0, 0, 0}}) {
    const auto found = field.distance(p);
    EXPECT_NEAR(found.distance, dot(normal, p), 1e-5f);
    EXPECT_NEAR(length(found.normal - normal), 0, 1e-5f);
  }
  EXPECT_GT(field.distance({2.01f, -5, 0}).distance, 1e9f) << "there is nothing beside it";
  const FirstHit<float> hit = field.first_hit({0.5f, 3, 0.4f}, {0.5f, -3, 0.4f}, 0);
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.point.y, 0.5f / 3, 1e-3f);
  EXPECT_FALSE(field.first_hit({0.5f, 3, 0.4f}, {0.5f, 1, 0.4f}, 0).hit);
}

TEST(SolidField, OfGroundEndsAtItsUnderside) {
  const SolidField field(heightfield_of(ramp().mesh));
  const float underside = -2.f / 3 - 4;  // it is as far below the lowest point as the terrain is wide
  EXPECT_NEAR(field.bounds().low.y, underside, 1e-5f);
  const auto below = field.distance({0.3f, underside - 0.5f, 0.2f}),
             in = field.distance({0.3f, underside + 0.5f, 0.2f});
  EXPECT_NEAR(below.distance, 0.5f, 1e-5f);
  EXPECT_NEAR(in.distance, -0.5f, 1e-5f);
  EXPECT_EQ(below.normal, (Vec3f{0, -1, 0}));
  EXPECT_EQ(in.normal, (Vec3f{0, -1, 0}));
  const FirstHit<float> hit = field.first_hit({0.5f, -9, 0.4f}, {0.5f, 9, 0.4f}, 0.1f);
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.point.y, underside - 0.1f, 1e-3f);
  EXPECT_EQ(hit.normal, (Vec3f{0, -1, 0}));
  EXPECT_FALSE(field.first_hit({0.5f, -9, 0.4f}, {0.5f, underside - 0.2f, 0.4f}, 0.1f).hit);
}

TEST(SolidField, IsMeasuredOnceAndShared) {
  MeshCollider one = ball(1, 0.5f), two = one;
  one.field = two.field = measure_distances(one.mesh);
  EXPECT_NEAR(one.field->spacing, 1.f / 48, 1e-4f);
  Scene scene;
  scene.add(one);
  scene.add(two);
  const World world(scene);
  EXPECT_EQ(one.field.use_count(), 4 + 2) << "two colliders here, two in the scene, two in the world";
}

MeshCollider measured_ball(float radius) {
  MeshCollider collider = ball(3, radius);
  collider.field = measure_distances(collider.mesh, 0.05f * radius);
  return collider;
}

/// Where particles end that fall on the collider from all over.
std::vector<Vec3f> rained_on(const MeshCollider& collider, float speed, float friction) {
  Scene scene;
  scene.settings = settings_of(10);
  MeshCollider solid = collider;
  solid.static_friction = solid.kinetic_friction = friction;
  scene.add(solid);
  std::vector<Vec3f> places;
  for (int i = 0; i < 36; ++i)
    places.push_back({-0.35f + 0.13f * static_cast<float>(i % 6), 1.5f, -0.35f + 0.13f * static_cast<float>(i / 6)});
  Object grains = loose_particles(places, std::vector<Vec3f>(36, Vec3f{0, -speed, 0}));
  grains.thickness = 0.01f;
  grains.static_friction = grains.kinetic_friction = friction;
  scene.add(grains);
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) EXPECT_TRUE(world.step(dt).ok());
  return world.object(0).positions();
}

TEST(SolidField, HoldsWhatFallsOnIt) {
  const MeshCollider slope = ramp(), round = measured_ball(0.6f);
  for (const Vec3f& p : rained_on(slope, 1, 2)) EXPECT_NEAR(p.y, p.x / 3 + 0.01f * std::sqrt(1 + 1.f / 9), 1e-3f);
  for (const Vec3f& p : rained_on(round, 1, 20)) EXPECT_NEAR(length(p), 0.61f, 0.005f);
}

TEST(SolidField, LetsNothingThroughThatIsFast) {
  const MeshCollider slope = ramp(), round = measured_ball(0.6f);
  for (const Vec3f& p : rained_on(slope, 300, 2)) EXPECT_TRUE(std::fabs(p.x) > 2 || p.y > p.x / 3) << p.x << " " << p.y;
  for (const Vec3f& p : rained_on(round, 300, 2)) EXPECT_TRUE(length(p) > 0.59f && (p.y > -1 || length(p) > 5)) << p.y;
}

/// The path of a particle near a ramp, alone or with another particle far above, which is in the same tile and extends
/// into the ground.
std::vector<Vec3f> way_near_the_ramp(const Vec3f& place, const Vec3f& velocity, bool with_another) {
  Scene scene;
  scene.gravity = {};
  scene.settings = settings_of(10);
  scene.add(ramp());
  std::vector<Vec3f> places{place}, velocities{velocity};
  if (with_another) {
    places.push_back({1, 0.2f, 0});
    velocities.push_back({});
  }
  Object grains = loose_particles(places, velocities);
  grains.thickness = 0.01f;
  scene.add(grains);
  World world(scene);
  std::vector<Vec3f> way{place};
  for (int frame = 0; frame < 40; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    way.push_back(world.object(0).positions()[0]);
  }
  return way;
}

TEST(SolidField, OfGroundIsSolidToADepthThatDependsOnNobodyElse) {
  const float underside = -2.f / 3 - 4;
  for (const float depth : {0.3f, 2.f, 3.9f, 4.3f, 8.f})
    EXPECT_EQ(way_near_the_ramp({0, -depth, 0}, {}, false), way_near_the_ramp({0, -depth, 0}, {}, true)) << depth;
  EXPECT_EQ(way_near_the_ramp({0, -8, 0}, {}, true).back().y, -8.f) << "nothing is solid there";
  const Vec3f out = way_near_the_ramp({0, -0.5f, 0}, {}, true).back();
  EXPECT_GT(out.y, out.x / 3) << "up";
  EXPECT_LT(way_near_the_ramp({0, -4.3f, 0}, {}, true).back().y, underside) << "down, which is closer";
  // A particle that comes from below stays below, and no particle is pushed out faster than 2 m/s.
  for (const float speed : {0.5f, 5.f, 300.f}) {
    const std::vector<Vec3f> way = way_near_the_ramp({0.3f, -6, 0.2f}, {0, speed, 0}, true);
    EXPECT_NEAR(way.back().y, std::fmin(-6 + 40 * speed * dt, underside - 0.01f), 1e-3f) << speed;
  }
  const std::vector<Vec3f> way =
      way_near_the_ramp({2.1f, -0.6f, 0}, {-1, 0, 0}, true);  // enters through a side of the terrain, which is open
  EXPECT_LT(way.back().x, 1.9f);
  EXPECT_GT(way.back().y, 0.3f) << "on its way up";
  for (std::size_t i = 1; i < way.size(); ++i) EXPECT_LT(length(way[i] - way[i - 1]), 2.3f * dt) << i;
}

TEST(SolidField, BringsOutWhatBeginsInside) {
  Scene scene;
  scene.gravity = {};
  scene.settings = settings_of(10);
  scene.add(measured_ball(0.5f));
  scene.add(loose_particles({{0.1f, 0.2f, 0.05f}, {-0.3f, 0, 0.1f}}));
  World world(scene);
  float before = length(world.object(0).positions()[1]);
  for (int frame = 0; frame < 30; ++frame) {
    world.step(dt);
    const float now = length(world.object(0).positions()[1]);
    EXPECT_LT((now - before) / dt, 2.1f) << "no faster than 2 m/s";
    before = now;
  }
  for (const Vec3f& p : world.object(0).positions()) EXPECT_GT(length(p), 0.49f);
}

TEST(SolidField, MovesAndIsMaskedAsTrianglesAre) {
  Scene scene;
  scene.gravity = {};
  scene.settings = settings_of(10);
  MeshCollider solid = measured_ball(0.5f);
  solid.motion = straight({0, 3, 0}, 1);
  solid.groups = 2;
  scene.add(solid);
  for (const std::uint32_t mask : {2u, 1u}) {
    Object grain = loose_particles({{0, 1, 0}});
    grain.mask = mask;
    scene.add(grain);
  }
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) world.step(dt);
  EXPECT_GE(world.object(0).positions()[0].y, 1.99f);  // it stays in front of the solid
  EXPECT_EQ(world.object(1).positions()[0].y, 1.f);
}

std::string field_refusal(const MeshCollider& collider) {
  Scene scene;
  scene.add(collider);
  return refusal_of(scene);
}

TEST(SolidField, IsRefusedWhereTheMeshIsNone) {
  MeshCollider open = ball(2, 1);
  open.mesh.triangles.pop_back();
  EXPECT_NE(field_refusal(open).find("object 'ball', edge"), std::string::npos) << field_refusal(open);
  EXPECT_NE(field_refusal(open).find("so the mesh is not closed"), std::string::npos);
  MeshCollider bent = ramp();
  bent.mesh.positions[20].x += 0.1f;
  EXPECT_NE(field_refusal(bent).find("object 'ramp', vertex 20: its x and z are not on the regular grid"),
            std::string::npos)
      << field_refusal(bent);
  MeshCollider alive = ball(1, 1);
  alive.frames = {{0, alive.mesh.positions}};
  EXPECT_NE(field_refusal(alive).find("which cannot deform"), std::string::npos);
  MeshCollider broken = ball(1, 1);
  broken.field = std::make_shared<DistanceField>();
  EXPECT_NE(field_refusal(broken).find("incomplete"), std::string::npos);
}

}  // namespace
}  // namespace pliant
