// Tests that scenes whose contact would take excessive memory and time are rejected, and that object and number are
// named.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "pliant/error.h"
#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// A sheet of `side` x `side` vertices, 0.01 m apart.
Object sheet(const char* name, int side, float thickness, const Vec3f& at) {
  TriangleMesh mesh = grid_mesh(side, side, 0.01f * static_cast<float>(side - 1), 0.01f * static_cast<float>(side - 1));
  for (Vec3f& p : mesh.positions) p = {p.x + at.x, p.y + at.y, p.z + at.z};
  ClothOptions options;
  options.name = name;
  Object object = make_cloth(mesh, options);
  object.thickness = thickness;
  object.self_collision = object.collides = true;
  return object;
}

std::string problem_of(const Scene& scene) {
  try {
    World world(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

bool says(const std::string& text, const char* words) { return text.find(words) != std::string::npos; }

TEST(ContactCost, ThicknessOfNineEdgesIsRefusedByName) {
  Scene scene;
  scene.objects = {sheet("thin", 8, 0.002f, {0, 1, 0}), sheet("felt", 60, 0.045f, {0, 0, 0})};
  const std::string problem = problem_of(scene);
  EXPECT_TRUE(says(problem, "felt") && says(problem, "thickness") && says(problem, "0.005 m or less")) << problem;
}

TEST(ContactCost, ThickLayersCountTogether) {
  Scene scene;
  scene.objects = {sheet("one", 60, 0.025f, {0, 0, 0})};
  EXPECT_EQ(problem_of(scene), "");
  for (const float y : {0.02f, 0.04f}) scene.objects.push_back(sheet("more", 60, 0.025f, {0, y, 0}));
  EXPECT_TRUE(says(problem_of(scene), "thickness")) << problem_of(scene);
}

TEST(ContactCost, SmallMeshesMayBeAsThickAsTheyLike) {
  Scene scene;
  scene.objects = {sheet("pad", 10, 1, {0, 0, 0})};
  EXPECT_EQ(problem_of(scene), "");
}

TEST(ContactCost, FarFromTheOriginIsRefusedByName) {
  Scene scene;
  scene.objects = {sheet("near", 8, 0.002f, {0, 0, 0}), sheet("distant", 8, 0.002f, {1e5f, 0, 0})};
  const std::string problem = problem_of(scene);
  EXPECT_TRUE(says(problem, "distant") && says(problem, "origin") && says(problem, "5208 m")) << problem;
  scene.objects[1].self_collision = scene.objects[1].collides = false;
  EXPECT_EQ(problem_of(scene), "");
}

TEST(ContactCost, WhatFliesFarHasNoContactThereAndTheReportSaysSo) {
  Scene scene;
  scene.objects = {sheet("bird", 20, 0.002f, {0, 0, 0})};
  World world(scene);
  State state = world.state();
  for (Record& p : state.positions) p.x += 1e6f;
  world.restore(state);
  const Report report = world.step(1.f / 60);
  const auto names_it = [](const std::string& warning) { return says(warning, "bird") && says(warning, "origin"); };
  EXPECT_TRUE(std::any_of(report.warnings.begin(), report.warnings.end(), names_it));
  EXPECT_EQ(report.pairs.contacts, 0);
}

}  // namespace
}  // namespace pliant
