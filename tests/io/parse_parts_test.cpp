// Single objects and colliders from text, and Reports as text: what World::add and other languages need.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pliant/describe.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/save.h"
#include "pliant/version.h"

namespace pliant {
namespace {

const char* const cloth_text = R"({"name": "flag", "pins": [{"particles": [0, 8]}], "cloth": {"material": "silk",
  "mesh": {"grid": {"columns": 9, "rows": 7, "width": 0.5, "depth": 0.4}}}})";
const char* const ball_text = R"({"sphere": {"radius": 0.1}, "position": [0, -0.3, 0]})";
const char* const ground_text = R"({"mesh": {"grid": {"columns": 3, "rows": 3, "width": 4, "depth": 4}},
  "position": [0, -1, 0], "as": "heightfield"})";

std::string refused(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ParseObject, GivesTheObjectOfAScene) {
  const Scene whole = parse_scene(
      std::string(R"({"objects": [)") + cloth_text + R"(], "colliders": [)" + ball_text + "," + ground_text + "]}",
      "scene", ".");
  Scene built;
  built.add(parse_object(cloth_text));
  for (const char* text : {ball_text, ground_text})
    std::visit([&](const auto& collider) { built.add(collider); }, parse_collider(text));
  EXPECT_EQ(fingerprint(built).scene, fingerprint(whole).scene);
}

TEST(ParseObject, TakesArraysValuesAndRepairs) {
  SceneReadOptions options;
  options.arrays.meshes["shirt"] = grid_mesh(4, 4, 1, 1);
  options.values = {{"/cloth/material", "denim"}};
  const Object object = parse_object(R"({"cloth": {"mesh": {"array": "shirt"}}})", "it", ".", options);
  EXPECT_EQ(object.name, "cloth");
  EXPECT_EQ(object.positions.size(), 16u);
  EXPECT_GT(object.masses[5], parse_object(R"({"cloth": {"material": "silk", "mesh": {"array": "shirt"}}})", "it", ".",
                                           {true, {}, options.arrays, {}})
                                  .masses[5]);
}

TEST(ParseObject, RefusesWhatASceneRefuses) {
  EXPECT_NE(refused([] { parse_object("{}", "call"); }).find("call:1:1"), std::string::npos);
  EXPECT_NE(refused([] { parse_object(R"({"cloth": {"mesh": {"array": "none"}}})"); }).find("none"), std::string::npos);
  EXPECT_NE(refused([] {
              parse_object(
                  R"({"cloth": {"mesh": {"grid": {"columns": 3, "rows": 3, "width": 1, "depth": 1}}}, "frixion": 1})");
            }).find("frixion"),
            std::string::npos);
  EXPECT_NE(refused([] { parse_object(ball_text); }), "");
  EXPECT_NE(refused([] { parse_collider(cloth_text); }), "");
  EXPECT_NE(refused([] { parse_collider("[1, 2"); }), "");
}

TEST(Find, FindsByName) {
  World world(Scene{});
  EXPECT_FALSE(world.find("flag"));
  const ObjectId flag = world.add(parse_object(cloth_text));
  const ColliderId ball = world.add(std::get<Collider>(parse_collider(ball_text)));
  const MeshColliderId ground = world.add(std::get<MeshCollider>(parse_collider(ground_text)));
  EXPECT_EQ(world.find("flag"), flag);
  EXPECT_EQ(world.find_collider("sphere"), ball);
  EXPECT_EQ(world.find_mesh_collider("mesh"), ground);
  EXPECT_FALSE(world.find("mesh"));
  EXPECT_FALSE(world.find_collider("flag"));
  EXPECT_EQ(world.object(flag).name(), "flag");
  EXPECT_EQ(world.object(flag).particle_count(), 63);
  EXPECT_EQ(world.collider(ball).name(), "sphere");
  EXPECT_EQ(world.mesh_collider(ground).name(), "mesh");
  EXPECT_EQ(world.mesh_collider(ground).vertex_count(), 9);
  world.remove(flag);
  EXPECT_FALSE(world.find("flag"));
  EXPECT_NE(refused([&] { (void)world.object(flag).name(); }), "");
}

TEST(ReportJson, HasTheMembersOfAReport) {
  Scene scene;
  scene.add(parse_object(cloth_text));
  World world(scene);
  Report report;
  for (int i = 0; i < 3; ++i) report = world.step(scene.frame_time);
  const auto json = nlohmann::json::parse(report_json(report, world));
  EXPECT_EQ(json["frame"], report.frame);
  EXPECT_EQ(json["ok"], true);
  EXPECT_EQ(json["substeps"], report.substeps);
  EXPECT_EQ(json["overstretch"]["p99"], report.overstretch->p99);
  EXPECT_EQ(json["worst_overstretch"]["object"], "flag");
  EXPECT_TRUE(json["nonfinite"].is_null());
  EXPECT_TRUE(json["warnings"].is_array());
  report.nonfinite = NonFinite{"flag", "particle 3", 7, 2};
  const auto bad = nlohmann::json::parse(report_json(report, world));
  EXPECT_EQ(bad["ok"], false);
  EXPECT_EQ(bad["nonfinite"]["element"], "particle 3");
}

TEST(Describe, NamesWhatIsThere) {
  Scene scene;
  scene.add(parse_object(cloth_text));
  scene.add(std::get<Collider>(parse_collider(ball_text)));
  scene.add(std::get<MeshCollider>(parse_collider(ground_text)));
  World world(scene);
  const Report report = world.step(scene.frame_time);
  for (const std::string& text : {describe(scene), describe(world)}) {
    EXPECT_NE(text.find("'flag': 63 particles"), std::string::npos) << text;
    EXPECT_NE(text.find("'sphere'"), std::string::npos) << text;
    EXPECT_NE(text.find("'mesh': mesh of "), std::string::npos) << text;
  }
  EXPECT_NE(describe(report).find("Report of frame 1 "), std::string::npos) << describe(report);
}

TEST(Version, IsThatOfTheHeaders) {
  EXPECT_EQ(version(), PLIANT_VERSION);
  EXPECT_EQ(version(), std::to_string(PLIANT_VERSION_MAJOR) + "." + std::to_string(PLIANT_VERSION_MINOR) + "." +
                           std::to_string(PLIANT_VERSION_PATCH));
}

}  // namespace
}  // namespace pliant
