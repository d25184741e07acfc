// Meshes and points in memory that a scene names: the same scene as from files and lists, and refusals that say what is
// wrong.
#include <gtest/gtest.h>

#include <limits>

#include "pliant/error.h"
#include "pliant/io.h"

namespace pliant {
namespace {

SceneFile parsed_with(const std::string& text, const SceneArrays& arrays) {
  SceneReadOptions options;
  options.arrays = arrays;
  return parse_scene_file(text, "test", "", options);
}

std::string refusal_with(const std::string& text, const SceneArrays& arrays) {
  try {
    parsed_with(text, arrays);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string hash_after(const SceneFile& file, int frames) {
  World world(file.scene);
  for (int i = 0; i < frames; ++i) world.step(file.scene.frame_time);
  return world.state_hash();
}

TEST(SceneArrays, AClothFromMemoryHasTheBitsOfAGrid) {
  const char* rest = R"(, "material": "cotton"}, "pins": [{"particles": [0, 8]}]}]})";
  const std::string grid = std::string(R"({"objects": [{"cloth": {"mesh": {
    "grid": {"columns": 9, "rows": 7, "width": 0.5, "depth": 0.4}})") +
                           rest;
  const std::string array = std::string(R"({"objects": [{"cloth": {"mesh": {"array": "shirt"})") + rest;
  SceneArrays arrays;
  arrays.meshes["shirt"] = grid_mesh(9, 7, 0.5f, 0.4f);
  EXPECT_EQ(hash_after(parsed_with(grid, {}), 5), hash_after(parsed_with(array, arrays), 5));
}

TEST(SceneArrays, VerticesThatFilesWouldMergeStay) {
  SceneArrays arrays;
  arrays.meshes["two"] = {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 0}, {-1, 0, 0}, {0, 0, -1}}, {{0, 1, 2}, {3, 4, 5}}};
  const SceneFile file = parsed_with(R"({"objects": [{"cloth": {"mesh": {"array": "two"}}}]})", arrays);
  EXPECT_EQ(file.scene.objects[0].positions.size(), 6u);
  EXPECT_TRUE(file.repairs.empty());
}

TEST(SceneArrays, PlacementAppliesToAMeshCollider) {
  SceneArrays arrays;
  arrays.meshes["ground"] = grid_mesh(3, 3, 1, 1);
  const SceneFile file = parsed_with(
      R"({"objects": [], "colliders": [{"mesh": {"array": "ground", "scale": 2, "translate": [0, 3, 0]}}]})", arrays);
  EXPECT_EQ(file.scene.mesh_colliders[0].mesh.positions[0], (Vec3f{-1, 3, -1}));
}

TEST(SceneArrays, TetrahedraFromMemoryHaveTheBitsOfABox) {
  const auto body = [](const std::string& source) {
    return R"({"objects": [{"soft_body": {"tetrahedra": )" + source + R"(, "material": {"youngs_modulus": 1e5}}}]})";
  };
  SceneArrays arrays;
  arrays.tetrahedra["liver"] = box_tetrahedra({0.2f, 0.1f, 0.1f}, {2, 1, 1});
  EXPECT_EQ(hash_after(parsed_with(body(R"({"box": {"size": [0.2, 0.1, 0.1], "cells": [2, 1, 1]}})"), {}), 3),
            hash_after(parsed_with(body(R"({"array": "liver"})"), arrays), 3));
}

TEST(SceneArrays, PointsFromMemoryStandInForPositions) {
  SceneArrays arrays;
  arrays.points["drops"] = {{0, 1, 0}, {0, 2, 0}};
  const SceneFile liquid =
      parsed_with(R"({"objects": [{"liquid": {"positions": {"array": "drops"}, "spacing": 0.1}}]})", arrays);
  EXPECT_EQ(liquid.scene.objects[0].positions, arrays.points["drops"]);
  const SceneFile particles =
      parsed_with(R"({"objects": [{"particles": {"positions": {"array": "drops"}, "masses": 1}}]})", arrays);
  EXPECT_EQ(particles.scene.objects[0].positions, arrays.points["drops"]);
}

TEST(SceneArrays, FramesOfAColliderTakePoints) {
  SceneArrays arrays;
  arrays.meshes["skin"] = grid_mesh(2, 2, 1, 1);
  arrays.points["later"] = {{0, 1, 0}, {1, 1, 0}, {0, 1, 1}, {1, 1, 1}};
  const SceneFile file = parsed_with(R"({"objects": [], "colliders": [{"mesh": {"array": "skin"}, "frames": [
    {"time": 0, "positions": [[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]]},
    {"time": 1, "positions": {"array": "later"}}]}]})",
                                     arrays);
  EXPECT_EQ(file.scene.mesh_colliders[0].frames[1].positions, arrays.points["later"]);
}

TEST(SceneArrays, AnUnknownNameIsRefusedWithTheNearest) {
  SceneArrays arrays;
  arrays.meshes["shirt"] = grid_mesh(2, 2, 1, 1);
  const std::string cloth = R"({"objects": [{"cloth": {"mesh": {"array": "shrit"}}}]})";
  EXPECT_EQ(
      refusal_with(cloth, arrays),
      "test:1:43: /objects/0/cloth/mesh/array: there is no array shrit of this kind; the nearest name is 'shirt'");
  EXPECT_EQ(refusal_with(cloth, {}),
            "test:1:43: /objects/0/cloth/mesh/array: there is no array shrit of this kind; give an array of this name "
            "with the scene, or name a 'file'");
}

TEST(SceneArrays, IndicesAndValuesAreChecked) {
  SceneArrays arrays;
  arrays.meshes["m"] = {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 3}}};
  const std::string cloth = R"({"objects": [{"cloth": {"mesh": {"array": "m"}}}]})";
  EXPECT_EQ(refusal_with(cloth, arrays),
            "test:1:43: /objects/0/cloth/mesh/array: triangle 0 of array m has vertex 3, but there are 3; give indices "
            "from 0 to 2");
  arrays.meshes["m"].triangles[0][2] = -1;
  EXPECT_NE(refusal_with(cloth, arrays), "");
  arrays.meshes["m"].triangles[0][2] = 2;
  arrays.meshes["m"].positions[1].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(refusal_with(cloth, arrays).find("vertex 1 is not finite"), std::string::npos);
  arrays.points["p"] = {{std::numeric_limits<float>::infinity(), 0, 0}};
  EXPECT_NE(refusal_with(R"({"objects": [{"particles": {"positions": {"array": "p"}, "masses": 1}}]})", arrays), "");
  arrays.tetrahedra["t"] = {{{0, 0, 0}}, {{0, 0, 0, 4}}};
  const std::string body = R"({"objects": [{"soft_body": {"tetrahedra": {"array": "t"}}}]})";
  EXPECT_NE(refusal_with(body, arrays).find("tetrahedron 0 of array t has vertex 4, but there are 1"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
