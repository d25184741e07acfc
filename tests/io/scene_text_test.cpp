// A Scene as JSON and back: nothing is lost, and what does not belong there is refused at its place.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/scene_support.h"
#include "pliant/save.h"
#include "support/scenes.h"

namespace pliant {
namespace {

using test::FullScene;

std::string why_not(const std::string& text) {
  try {
    scene_from_json(text, "it");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string with(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? text : text.replace(at, old.size(), by);
}

TEST_F(FullScene, IsTheSameThroughJson) {
  const std::string text = scene_json(scene);
  const Scene again = scene_from_json(text);
  EXPECT_EQ(fingerprint(again).scene, fingerprint(scene).scene);
  EXPECT_EQ(fingerprint(again).settings, fingerprint(scene).settings);
  EXPECT_EQ(scene_json(again), text) << "also what changes no bits";
}

TEST(SceneText, EverySceneOfTheGalleryIsTheSameThroughIt) {
  for (const char* name :
       {"bodies/bowl.json", "bodies/car.json", "rods/hair.json", "bags/water.json", "gas/plume.json", "flag.json"}) {
    const Scene scene = read_scene(test::in_tree(std::string("scenes/") + name));
    EXPECT_EQ(fingerprint(scene_from_json(scene_json(scene))).scene, fingerprint(scene).scene) << name;
  }
}

TEST(SceneText, IsReadableAndCanBeChanged) {
  Scene scene;
  scene.add(make_rope({{0, 0, 0}, {0.1f, 0, 0}, {0.2f, 0, 0}}));
  scene.objects[0].masses[0] = std::numeric_limits<float>::infinity();
  scene.objects[0].name = "a \"rope\"\n\\";
  const auto tree = nlohmann::json::parse(scene_json(scene));
  EXPECT_EQ(tree["objects"][0]["name"], "a \"rope\"\n\\");
  EXPECT_EQ(tree["objects"][0]["masses"][0], "infinity");
  EXPECT_EQ(tree["objects"][0]["positions"][1].dump(), "[0.1,0,0]");
  EXPECT_EQ(tree["settings"]["sweep"], "automatic");
  const Scene changed =
      scene_from_json(with(scene_json(scene), "\"integrator\": \"pbd\"", "\"integrator\": \"energy\""));
  EXPECT_EQ(changed.settings.integrator, Settings::Integrator::energy);
  EXPECT_EQ(changed.objects[0].masses, scene.objects[0].masses);
}

TEST(SceneText, RefusesWhatIsNone) {
  Scene scene;
  scene.add(make_rope({{0, 0, 0}, {0.1f, 0, 0}, {0.2f, 0, 0}}));
  Collider ball;
  ball.shape = Sphere{0.5f};
  scene.add(ball);
  const std::string text = scene_json(scene);
  EXPECT_EQ(why_not(text), "");
  EXPECT_NE(why_not("[]").find("scene_json()"), std::string::npos);
  EXPECT_NE(why_not(R"({"objects": []})").find("read_scene()"), std::string::npos);
  EXPECT_NE(why_not(with(text, "\"pliant_scene\": ", "\"pliant_scene\": 9")).find("is version 9"), std::string::npos);
  EXPECT_NE(why_not(with(text, "\"frames\": 120", "\"frames\": 1.5")).find("/frames: is not an integer"),
            std::string::npos);
  EXPECT_NE(why_not(with(text, "\"frames\": 120", "\"frames\": 1e300")).find("is not an integer"), std::string::npos);
  EXPECT_NE(why_not(with(text, "\"restitution\": 0", "\"restitution\": 1e300")).find("/objects/0/restitution"),
            std::string::npos);
  EXPECT_NE(why_not(with(text, "\"frames\"", "\"framse\"")).find("framse"), std::string::npos);
  EXPECT_NE(why_not(with(text, "\"automatic\"", "\"fast\"")).find("'chains'"), std::string::npos);
  EXPECT_NE(why_not(with(text, "\"sphere\"", "\"ball\"")).find("/colliders/0/shape"), std::string::npos);
  EXPECT_NE(why_not(with(text, "[0, -9.81, 0]", "[0, -9.81]")).find("an array of 3 values"), std::string::npos);
  for (std::size_t size = 0; size + 2 < text.size(); size += 41) EXPECT_NE(why_not(text.substr(0, size)), "") << size;
  scene.forces.push_back(ForceField([](const Vec3f&, const Vec3f&, float, float) { return Vec3f{}; }));
  EXPECT_THROW(scene_json(scene), Error);
}

}  // namespace
}  // namespace pliant
