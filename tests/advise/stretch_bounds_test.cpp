// The bounds of stretch by default settings: kept, or the advice names substeps that keep them.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/material.h"
#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// The worst overstretch of a run, and the advice that it gets.
struct Outcome {
  Overstretch worst;
  std::string advice;
};

Outcome run_of(const Scene& scene, int frames) {
  World world(scene);
  Report report;
  for (int frame = 0; frame < frames; ++frame) report = world.step(1.f / 60);
  EXPECT_TRUE(report.ok());
  const Overstretch worst = report.worst_overstretch.overstretch;
  return {worst, world.measure().advice(worst)};
}

/// The number of substeps that an advice names; 0: none.
int named(const std::string& advice) {
  const std::string before = "\"substeps\": ";
  const std::size_t at = advice.find(before);
  return at == std::string::npos ? 0 : std::stoi(advice.substr(at + before.size()));
}

/// The default is beyond the bounds, and what the advice names is within them.
void expect_named(Scene scene, int frames) {
  const Outcome by_default = run_of(scene, frames);
  EXPECT_FALSE(is_tolerable(by_default.worst));
  EXPECT_NE(by_default.advice.find("object 'cloth': stretched "), std::string::npos) << by_default.advice;
  scene.settings.substeps = named(by_default.advice);
  ASSERT_GT(scene.settings.substeps, 0) << by_default.advice;
  const Overstretch held = run_of(scene, frames).worst;
  EXPECT_TRUE(is_tolerable(held)) << scene.settings.substeps << ": " << held.p99 << ", " << held.largest;
}

Object cloth_of(const TriangleMesh& mesh, const Fabric& material) {
  ClothOptions options;
  options.name = "cloth";
  options.material = material;
  return make_cloth(mesh, options);
}

Scene on_one_thread() {
  Scene scene;
  scene.settings.threads = 1;
  return scene;
}

/// A quarter of a disc of 0.5 m in 200 triangles, whose edges are as 1 to 127. It had 16 % (p99 6.3 %) in 85 substeps.
TEST(StretchBounds, HoldInAFanOfSlivers) {
  TriangleMesh fan;
  fan.positions = {{0, 1, 0}};
  for (int i = 0; i <= 200; ++i) {
    const float angle = 1.5707963f * static_cast<float>(i) / 200;
    fan.positions.push_back({0.5f * std::cos(angle), 1, 0.5f * std::sin(angle)});
    if (i > 0) fan.triangles.push_back({0, i + 1, i});
  }
  Scene scene = on_one_thread();
  Object cloth = cloth_of(fan, fabric("cotton"));
  cloth.thickness = 0.0002f;
  cloth.pins = {{1}, {201}};
  scene.add(std::move(cloth));
  scene.add(Collider{.name = "ground"});
  const Overstretch worst = run_of(scene, 70).worst;
  EXPECT_LE(worst.largest, tolerated_overstretch);
  EXPECT_LE(worst.p99, tolerated_p99);
}

/// 1 kg hits 10 g at 4 m/s.
TEST(StretchBounds, AreNamedForAHeavyBallOnLightCloth) {
  Fabric light;
  light.area_density = 0.0025f;
  TriangleMesh mesh = grid_mesh(25, 25, 2, 2);
  for (Vec3f& p : mesh.positions) p.y += 1;
  Scene scene = on_one_thread();
  Object cloth = cloth_of(mesh, light);
  cloth.thickness = 0.004f;
  cloth.collides = true;
  cloth.pins = {{0}, {24}, {600}, {624}};
  scene.add(std::move(cloth));
  Object ball = make_body({{Sphere{0.2f}}}, {.position = {0, 1.25f, 0}, .velocity = {0, -4, 0}, .mass = 1});
  scene.add(std::move(ball));
  expect_named(scene, 9);
}

/// A cape whose pins go to and fro at 20 m/s, in front of nothing.
TEST(StretchBounds, AreNamedForACapeThatIsJerked) {
  TriangleMesh mesh = grid_mesh(13, 17, 0.6f, 0.9f);
  Scene scene = on_one_thread();
  Object cloth = cloth_of(mesh, fabric("cotton"));
  cloth.thickness = 0.004f;
  cloth.self_collision = true;
  Motion motion;
  for (int i = 0; i < 8; ++i)
    motion.keyframes.push_back({.time = 0.1f * static_cast<float>(i), .position = {i % 2 == 0 ? 0.f : 2.f, 0, 0}});
  for (int i = 0; i < 13; ++i) cloth.pins.push_back({i, motion});
  scene.add(std::move(cloth));
  expect_named(scene, 34);
}

}  // namespace
}  // namespace pliant
