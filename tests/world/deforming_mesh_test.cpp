// Tests mesh colliders that deform by frames: the velocity of their surface acts on bodies, as that of a mesh that
// moves rigidly does.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "support/run.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::float_pi;
using testing_support::run;

/// A quad of 2 m x 2 m at y = 0.
MeshCollider floor_quad() {
  MeshCollider collider;
  collider.mesh = grid_mesh(2, 2, 2, 2);
  collider.static_friction = collider.kinetic_friction = 0.8f;
  return collider;
}

/// Gives a mesh a frame for each 60th of a second, in which vertex p of the mesh is at place(p, time).
template <class Place>
MeshCollider with_frames(MeshCollider collider, int frames, const Place& place) {
  for (int i = 0; i <= frames; ++i) {
    const float time = static_cast<float>(i) / 60;
    MeshFrame frame{time, collider.mesh.positions};
    for (Vec3f& p : frame.positions) p = place(p, time);
    collider.frames.push_back(frame);
  }
  return collider;
}

Object box_on_mesh(const Vec3f& position) {
  Object box = make_body({{.shape = Box{{0.1f, 0.1f, 0.1f}}}}, {.position = position});
  box.static_friction = box.kinetic_friction = 0.8f;
  return box;
}

Vec3f place_on_mesh(const World& world, int object = 0) { return world.object(object).positions()[0]; }

/// A path that speeds up at 2 m/s^2 for 0.5 s, then goes on with 1 m/s.
float mesh_path(float time) { return time < 0.5f ? time * time : 0.25f + (time - 0.5f); }

TEST(DeformingMesh, CarriesABoxAsAMeshDoesThatMoves) {
  Scene by_frames, by_motion;
  by_frames.add(box_on_mesh({0, 0.1f, 0}));
  by_motion.add(box_on_mesh({0, 0.1f, 0}));
  by_frames.add(with_frames(floor_quad(), 120, [](const Vec3f& p, float time) {
    return p + Vec3f{mesh_path(time), 0, 0};
  }));
  MeshCollider moving = floor_quad();
  for (int i = 0; i <= 120; ++i) {
    const float time = static_cast<float>(i) / 60;
    moving.motion.keyframes.push_back({time, {mesh_path(time), 0, 0}});
  }
  by_motion.add(moving);
  World deforms(by_frames), moves(by_motion);
  run(deforms, 120);
  run(moves, 120);
  EXPECT_NEAR(place_on_mesh(deforms).x, mesh_path(2), 0.01) << "friction holds, so it is where the mesh is";
  EXPECT_NEAR(place_on_mesh(deforms).x, place_on_mesh(moves).x, 1e-3);
  EXPECT_NEAR(place_on_mesh(deforms).y, 0.1, 1e-3);
}

/// One edge of the quad moves away from the other: what lies at a quarter of its width moves with a quarter of the
/// speed.
TEST(DeformingMesh, CarriesABoxWithTheVelocityWhereItLies) {
  Scene scene;
  scene.add(box_on_mesh({-0.5f, 0.1f, 0}));
  scene.add(with_frames(floor_quad(), 120, [](const Vec3f& p, float time) {
    return Vec3f{p.x + mesh_path(time) * (p.x + 1) / 2, p.y, p.z};
  }));
  World world(scene);
  run(world, 120);
  EXPECT_NEAR(place_on_mesh(world).x, -0.5 + 0.25 * mesh_path(2), 0.01);
}

TEST(DeformingMesh, CarriesABoxRound) {
  Scene scene;
  scene.add(box_on_mesh({0.7f, 0.1f, 0}));
  const auto angle = [](float time) { return mesh_path(time) * float_pi / 4; };
  scene.add(with_frames(floor_quad(), 120, [&](const Vec3f& p, float time) {
    const float c = std::cos(angle(time)), s = std::sin(angle(time));
    return Vec3f{c * p.x + s * p.z, p.y, c * p.z - s * p.x};
  }));
  World world(scene);
  run(world, 120);
  const Vec3f at = place_on_mesh(world);
  EXPECT_NEAR(std::hypot(at.x, at.z), 0.7, 0.01);
  EXPECT_NEAR(std::atan2(-at.z, at.x), angle(2), 0.02);
  const Quatf turned = world.object(0).pose(0).rotation;
  EXPECT_NEAR(2 * std::atan2(turned.y, turned.w), angle(2), 0.05);
}

/// Without gravity a ball at rest that a wall of speed v hits leaves with (1 + e) v.
TEST(DeformingMesh, GivesWhatItHitsTheSpeedThatRestitutionAsks) {
  for (const float restitution : {0.f, 0.5f, 1.f}) {
    Scene scene;
    scene.gravity = {};
    Object ball = make_body({{.shape = Sphere{0.1f}}}, {.position = {0.3f, 0.25f, 0.1f}});
    ball.restitution = restitution;
    scene.add(ball);
    scene.add(with_frames(floor_quad(), 60, [](const Vec3f& p, float time) { return p + Vec3f{0, 3 * time, 0}; }));
    World world(scene);
    run(world, 20);
    EXPECT_NEAR(world.object(0).velocities()[0].y, 3 * (1 + restitution), 0.03) << restitution;
  }
}

/// A floor that tilts about its edge lifts what lies on it by its angle and keeps touching it.
TEST(DeformingMesh, TiltsWhatLiesOnIt) {
  Scene scene;
  scene.add(box_on_mesh({0, 0.1f, 0}));
  const auto angle = [](float time) { return 0.2f * mesh_path(time); };
  scene.add(with_frames(floor_quad(), 60, [&](const Vec3f& p, float time) {
    const float along = p.x + 1;
    return Vec3f{-1 + along * std::cos(angle(time)), along * std::sin(angle(time)), p.z};
  }));
  World world(scene);
  run(world, 60);
  const double c = std::cos(angle(1)), s = std::sin(angle(1));
  EXPECT_NEAR(place_on_mesh(world).x, -1 + c - 0.1 * s, 5e-3);
  EXPECT_NEAR(place_on_mesh(world).y, s + 0.1 * c, 5e-3);
  EXPECT_NEAR(2 * std::asin(world.object(0).pose(0).rotation.z), angle(1), 5e-3);
}

TEST(DeformingMesh, CarriesBodiesAsTheUserMovesItsVertices) {
  Scene scene;
  scene.add(box_on_mesh({0, 0.1f, 0}));
  const MeshCollider floor = floor_quad();
  scene.add(floor);
  World world(scene);
  for (int frame = 1; frame <= 60; ++frame) {
    std::vector<Vec3f> positions = floor.mesh.positions;
    for (Vec3f& p : positions) p.x += mesh_path(static_cast<float>(frame) / 60);
    world.mesh_collider(0).set_positions(positions);
    run(world, 1);
  }
  EXPECT_NEAR(place_on_mesh(world).x, mesh_path(1), 0.01);
  run(world, 60);
  EXPECT_LT(place_on_mesh(world).x, mesh_path(1) + 0.1) << "it stops with the mesh: 1 m/s is lost on 64 mm";
  EXPECT_NEAR(world.object(0).velocities()[0].x, 0, 1e-3);
}

TEST(DeformingMesh, CarriesOnAfterARestoreWithTheSameBits) {
  Scene scene;
  scene.add(box_on_mesh({0, 0.1f, 0}));
  scene.add(with_frames(floor_quad(), 60, [](const Vec3f& p, float time) {
    return p + Vec3f{mesh_path(time), 0.1f * mesh_path(time), 0};
  }));
  World world(scene), other(scene);
  run(world, 20);
  other.restore(world.state());
  run(world, 20);
  run(other, 20);
  EXPECT_EQ(world.state_hash(), other.state_hash());
}

}  // namespace
}  // namespace pliant
