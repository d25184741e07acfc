// Tests what is refused of parts that are tied to bodies.
#include <string>
#include <utility>
#include <vector>

#include "scene_support.h"

namespace pliant {
namespace {

void expect_refusal(const std::string& scene, const std::string& expected) {
  const std::string found = test::scene_message(scene);
  EXPECT_NE(found.find(expected), std::string::npos) << scene << "\n" << found;
}

TEST(SceneParts, AreNamedInErrors) {
  const std::string start = R"({"objects": [{"bodies": [{"name": "crate", "solids": [{"box": {}}]}], "parts": [
)",
                    rope = R"("rope": {"line": {"from": [0, 2, 0], "to": [0, 1, 0], "points": 3}})";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"{" + rope + R"(, "ties": [{"particles": [2], "body": "crat"}]})",
       "/objects/0/parts/0/ties/0/body: the object has no body 'crat'; did you mean 'crate'?"},
      {"{" + rope + R"(, "ties": [{"particles": [3], "body": "crate"}]})",
       "/objects/0/parts/0/ties/0/particles/0: there is no particle 3; the object has 3, counted from 0"},
      {"{" + rope + R"(, "pins": [{"particles": [0]}, {"particles": "ends"}]})",
       "/objects/0/parts/0/pins/1/particles: particle 0 is already pinned"},
      {R"({"cloth": {"mesh": {"sphere": {"subdivisions": 1}}, "volume": {}}})",
       "/objects/0/parts/0/cloth/volume: a part has no volume constraint"},
      {R"({"ties": []})", "/objects/0/parts/0"},
  };
  for (const auto& [part, expected] : cases) expect_refusal(start + part + "]}]}", expected);
}

TEST(SceneParts, AreOfObjectsOfBodiesAlone) {
  expect_refusal(R"({"objects": [{"rope": {"points": [[0, 0, 0], [1, 0, 0]]}, "parts": []}]})",
                 "/objects/0/parts: only an object of bodies has parts");
}

}  // namespace
}  // namespace pliant
