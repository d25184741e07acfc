// Members of a scene that are set by JSON pointer before it is read.
#include <gtest/gtest.h>

#include "pliant/error.h"
#include "pliant/io.h"

namespace pliant {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

const char* const two_ropes = R"({"objects": [
  {"rope": {"line": {"from": [0, 0, 0], "to": [1, 0, 0], "points": 5}}},
  {"name": "b", "rope": {"line": {"from": [0, 1, 0], "to": [1, 1, 0], "points": 5}}}]})";

Scene scene_set(const Values& values) {
  SceneReadOptions options;
  options.values = values;
  return parse_scene_file(two_ropes, "test", "", options).scene;
}

std::string refusal_of_set(const Values& values) {
  try {
    scene_set(values);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SceneSet, ReplacesAndAddsMembers) {
  const Scene scene = scene_set({{"/settings/substeps", "7"},
                                 {"/objects/1/name", "second"},
                                 {"/objects/0/colour", "[1, 0, 0.5]"},
                                 {"/colliders/-", R"({"plane": {}, "name": "ground"})"},
                                 {"/gravity", "[0, -1.5, 0]"}});
  EXPECT_EQ(scene.settings.substeps, 7);
  EXPECT_EQ(scene.objects[1].name, "second");
  EXPECT_EQ(scene.objects[0].colour, (Vec3f{1, 0, 0.5f}));
  EXPECT_EQ(scene.colliders.at(0).name, "ground");
}

TEST(SceneSet, LaterValuesReplaceEarlierOnes) {
  EXPECT_EQ(scene_set({{"/frames", "3"}, {"/frames", "4"}}).frames, 4);
  EXPECT_EQ(scene_set({{"/settings", R"({"substeps": 3})"}, {"/settings/substeps", "5"}}).settings.substeps, 5);
}

TEST(SceneSet, TakesTextThatIsNoJsonAsText) {
  EXPECT_EQ(scene_set({{"/objects/0/name", "left rope"}}).objects[0].name, "left rope");
  EXPECT_EQ(scene_set({{"/objects/0/name", "\"12\""}}).objects[0].name, "12");
}

TEST(SceneSet, RefusesWithThePathAndThePlaceInTheFile) {
  EXPECT_EQ(refusal_of_set({{"/objects/0/colour/0", "2"}}).find("test:2:3: /objects/0/colour"), 0u)
      << refusal_of_set({{"/objects/0/colour/0", "2"}});
  EXPECT_EQ(refusal_of_set({{"/objects/2/name", "c"}}),
            "test:1:13: /objects: there is no item '2' to set; give 0 to 1, or '-' to add one");
  EXPECT_EQ(refusal_of_set({{"/objects/0x/name", "c"}}).find("test:1:13: /objects: there is no item '0x'"), 0u);
  EXPECT_EQ(refusal_of_set({{"/objects/1/name/x", "c"}}),
            "test:3:12: /objects/1/name: this has no member 'x' to set; it is neither an object nor an array");
  EXPECT_EQ(refusal_of_set({{"settings", "c"}}),
            "'settings' is no JSON pointer; begin with '/', as in /settings/substeps");
  EXPECT_NE(refusal_of_set({{"/setings/substeps", "7"}}).find("'setings' is unknown"), std::string::npos);
  EXPECT_NE(refusal_of_set({{"/settings/substeps", "seven"}}).find("/settings/substeps"), std::string::npos);
}

TEST(SceneSet, NeverCrashesOnStrangePointersAndValues) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "/a";
  EXPECT_NE(refusal_of_set({{deep, "1"}}).find("leads more than 64 levels deep"), std::string::npos);
  for (const char* pointer : {"", "/", "//", "/~", "/~2", "/objects/", "/objects/-/-", "/objects/99999999999",
                              "/objects/-1", "/objects/0/rope/line/from/0"})
    for (const char* value : {"", "null", "{", "[[[[", "1e999", "\xff", "\"\\ud800\"", "{}", "[]"})
      EXPECT_NO_FATAL_FAILURE(refusal_of_set({{pointer, value}})) << pointer << " " << value;
}

}  // namespace
}  // namespace pliant
