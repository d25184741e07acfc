// Tests what the camera shows when it is told where to look, and what it leaves outside when it is not.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "pliant/body.h"
#include "render/eye_and_sun.h"
#include "render/matrix.h"
#include "render/render.h"

namespace pliant::render {
namespace {

float gap(const Vec3f& a, const Vec3f& b) { return std::sqrt(length_squared(a - b)); }

/// Particles on a grid in a cube of 1 m around the origin.
std::vector<Vec3f> cube_of_points() {
  std::vector<Vec3f> points;
  for (int i = 0; i < 1000; ++i)
    points.push_back(Vec3f{static_cast<float>(i % 10), static_cast<float>(i / 10 % 10), static_cast<float>(i / 100)} *
                         (1 / 9.f) -
                     Vec3f{0.5f, 0.5f, 0.5f});
  return points;
}

TEST(CameraOptions, LooksAtThePointFromTheDistance) {
  RenderScene scene;
  scene.balls.push_back({.centres = cube_of_points()});
  const Camera camera = frame_camera({scene}, 300, 200, {.look_at = Vec3f{1, 2, 3}, .distance = 4.f});
  EXPECT_EQ(camera.target, (Vec3f{1, 2, 3}));
  EXPECT_NEAR(gap(camera.eye, camera.target), 4, 1e-5f);
  const Camera fitted = frame_camera({scene}, 300, 200);
  const Camera turned = frame_camera({scene}, 300, 200, {.look_at = Vec3f{1, 2, 3}});
  EXPECT_NEAR(gap(turned.eye, turned.target), gap(fitted.eye, fitted.target), 1e-4f) << "as far as by itself";
  const Camera near = frame_camera({scene}, 300, 200, {.distance = 0.5f});
  EXPECT_NEAR(gap(near.target, fitted.target), 0, 1e-6f) << "at what it shows by itself";
}

TEST(CameraOptions, AWiderViewIsNearer) {
  RenderScene scene;
  scene.balls.push_back({.centres = cube_of_points()});
  const Camera narrow = frame_camera({scene}, 200, 200, {.field_of_view = 10});
  const Camera wide = frame_camera({scene}, 200, 200, {.field_of_view = 60});
  EXPECT_EQ(wide.field_of_view, 60);
  EXPECT_GT(gap(narrow.eye, narrow.target), 3 * gap(wide.eye, wide.target));
}

TEST(CameraOptions, ThePositionIsWhereItSaysAndAnglesTurnItAbout) {
  RenderScene scene;
  scene.balls.push_back({.centres = cube_of_points()});
  for (const Vec3f& position : {Vec3f{3, 1, -2}, Vec3f{1, 7, 3}, Vec3f{1, -4, 3}}) {
    const SceneCamera from{.look_at = Vec3f{1, 2, 3}, .position = position};
    const Camera camera = frame_camera({scene}, 300, 200, from);
    EXPECT_EQ(camera.target, (Vec3f{1, 2, 3}));
    EXPECT_NEAR(gap(camera.eye, position), 0, 2e-3f);
    const Camera near = frame_camera({scene}, 300, 200, merged({.distance = 0.5f}, from));
    EXPECT_NEAR(gap(near.eye, near.target), 0.5f, 1e-5f);
    EXPECT_NEAR(gap(near.eye - near.target, (camera.eye - camera.target) * (0.5f / gap(camera.eye, camera.target))), 0,
                1e-5f);
  }
  const Camera at_the_middle = frame_camera({scene}, 300, 200, {.position = Vec3f{0, 0, 5}});
  EXPECT_NEAR(gap(at_the_middle.target, {}), 0, 1e-6f);
  EXPECT_NEAR(gap(at_the_middle.eye, {0, 0, 5}), 0, 1e-5f);
  for (const Vec3f& middle : {Vec3f{}, Vec3f{1e-8f, 0, 0}}) {
    const Camera in_it = frame_camera({scene}, 300, 200, {.position = middle});
    EXPECT_GT(gap(in_it.eye, in_it.target), 0.1f) << "no direction: that of no position";
  }
}

TEST(CameraOptions, WhatIsLookedAtFromNearIsNotCutOff) {
  RenderScene scene;
  scene.balls.push_back({.centres = cube_of_points()});
  const auto near = [&](float distance) {
    const Camera camera = frame_camera({scene}, 300, 200, {.look_at = Vec3f{}, .distance = distance});
    return make_eye(camera, 300, 200, extent_of({scene})).near;
  };
  for (const float distance : {1e-3f, 1e-2f, 0.04f}) EXPECT_LT(near(distance), 0.51f * distance) << distance;
  EXPECT_EQ(near(5), near(50)) << "by the size of what is there";
}

TEST(CameraOptions, AreMergedOneByOne) {
  const SceneCamera both = merged({.azimuth = 1.f, .look_at = Vec3f{1, 1, 1}},
                                  {.azimuth = 2.f, .elevation = 3.f, .field_of_view = 50.f, .distance = 4.f});
  EXPECT_EQ(both.azimuth, 1);
  EXPECT_EQ(both.elevation, 3);
  EXPECT_EQ(both.field_of_view, 50);
  EXPECT_EQ(both.look_at, (Vec3f{1, 1, 1}));
  EXPECT_EQ(both.distance, 4);
  EXPECT_FALSE(both.position);
}

TEST(FrameCamera, LeavesOutWhatStraysFarFromTheRest) {
  RenderScene scene;
  scene.balls.push_back({.centres = cube_of_points()});
  const float radius = extent_of({scene}).radius;
  for (int i = 0; i < 20; ++i) scene.balls[0].centres.push_back({30, static_cast<float>(i), 0});
  EXPECT_NEAR(extent_of({scene}).radius, radius, 1e-4f) << "20 of 1 020 particles";
  for (int i = 0; i < 80; ++i) scene.balls[0].centres.push_back({30, static_cast<float>(i), 0});
  EXPECT_GT(extent_of({scene}).radius, 10) << "100 of 1 100 are no strays";
}

TEST(FrameCamera, LeavesOutOneOfManyBodiesButNotOneOfTwo) {
  const auto mesh = std::make_shared<const TriangleMesh>(mesh_of({{Box{{0.4f, 0.4f, 0.4f}}}}));
  RenderScene scene;
  for (int i = 0; i < 100; ++i)
    scene.bodies.push_back({mesh, {{static_cast<float>(i % 10), 0, static_cast<float>(i / 10)}, {}}, {}});
  const float radius = extent_of({scene}).radius;
  scene.bodies.push_back({mesh, {{500, 0, 0}, {}}, {}});
  EXPECT_NEAR(extent_of({scene}).radius, radius, 1e-3f);
  scene.bodies.back().mesh = std::make_shared<const TriangleMesh>(mesh_of({{Box{{2, 2, 2}}}}));
  EXPECT_GT(extent_of({scene}).radius, 200) << "it is larger than the others";
  scene.bodies.back().mesh = mesh;
  scene.bodies.erase(scene.bodies.begin() + 1, scene.bodies.end() - 1);
  EXPECT_GT(extent_of({scene}).radius, 200);
}

}  // namespace
}  // namespace pliant::render
