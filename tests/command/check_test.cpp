// Tests `pliant check`, and what all commands say of meshes that were repaired.
#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <string>

#include "command/command_fixture.h"

namespace pliant {
namespace {

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

class Mended : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    std::ofstream(folder_ / "patch.obj") << "v 0 0 0\nv 0 0 2\nv 3 0 0\nv 9 9 9\nf 1 2 3\n";
    std::ofstream(folder_ / "patch.json")
        << R"({"frames": 1, "objects": [{"name": "p", "cloth": {"mesh": {"file": "patch.obj"}}}]})";
  }
  const std::string line = "repaired: object 'p', patch.obj: dropped 1 vertex of no triangle, the first 3\n";
};

TEST_F(Mended, IsSaidByRunAsByCheck) {
  EXPECT_NE(pliant("check patch.json").out.find(line), std::string::npos);
  const Result run = pliant("run patch.json");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out.rfind(line, 0), 0u) << run.out;
  EXPECT_EQ(pliant("run patch.json --quiet").out, "");
}

TEST_F(Mended, IsSaidByRender) {
  if (const std::string why = why_nothing_is_drawn(); !why.empty()) GTEST_SKIP() << why;
  const Result drawn = pliant("render patch.json --out patch.png --size 64x48");
  EXPECT_EQ(drawn.out, line + "wrote patch.png\n") << drawn.err;
}

TEST_F(Command, CheckFindsNothingWrongInASoundScene) {
  const Result result = pliant("check small.json");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("1 object of 144 particles, 1 x 0 x 1 m"), std::string::npos) << result.out;
}

TEST_F(Command, CheckRunsASceneAndNamesTheDefaultThatWouldMendIt) {
  std::ofstream(folder_ / "sagging.json") << R"({"frames": 20, "settings": {"sweep": "tiled", "substeps": 2},
      "objects": [{"name": "sheet",
      "cloth": {"mesh": {"grid": {"columns": 12, "rows": 12, "width": 1, "depth": 1}}, "stretch": {"compliance": 0}},
      "pins": [{"particles": [0, 11]}]}]})";
  const Result result = pliant("check sagging.json --seconds 600");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("doubtful: in frame "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("object 'sheet': stretched "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" keeps all edges within 10 % and 99 in 100 within 2 % of the length"), std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find("remove \"sweep\" and \"substeps\" from the scene's \"settings\"\n"), std::string::npos)
      << result.out;
  EXPECT_EQ(result.out.find("--seconds"), std::string::npos) << "there was time enough";
  EXPECT_LE(longest_line(result.out), 180u) << result.out;
  EXPECT_EQ(pliant("check sagging.json --seconds 0").out.find("stretched"), std::string::npos) << "not run at all";

  Json scene = Json::parse(slurp(folder_ / "sagging.json"));
  scene["gravity"] = {0, -1e5, 0};
  std::ofstream(folder_ / "heavy.json") << scene.dump();
  const std::string hasty = pliant("check heavy.json --seconds 1e-3").out;
  EXPECT_NE(hasty.find(" --seconds 0.03 tries more\n"), std::string::npos) << hasty;
  scene.erase("gravity");
  scene["settings"].erase("sweep");
  scene["settings"].erase("substeps");
  std::ofstream(folder_ / "mended.json") << scene.dump();
  const std::string short_run = pliant("check mended.json --seconds 1e-6").out;
  EXPECT_NE(short_run.find("\nnothing wrong, nothing doubtful in 1 of 20 frames\n"), std::string::npos) << short_run;
  EXPECT_NE(pliant("check mended.json --seconds 600").out.find("nothing wrong, nothing doubtful"), std::string::npos);
  expect_refused("check sagging.json --seconds -1", 2, "seconds");
}

/// A default that does not suffice: several iterations make it `tiled` with 20 substeps.
TEST_F(Command, CheckNamesSettingsWhereTheDefaultDoesNotSuffice) {
  std::ofstream(folder_ / "sagging.json")
      << R"({"frames": 20, "settings": {"iterations": 2}, "objects": [{"name": "sheet",
      "cloth": {"mesh": {"grid": {"columns": 32, "rows": 32, "width": 1, "depth": 1}}, "stretch": {"compliance": 0}},
      "pins": [{"particles": [0, 31]}]}]})";
  const Result result = pliant("check sagging.json --seconds 600");
  const std::string mark = "add to the scene's \"settings\": ";
  const std::size_t at = result.out.find(mark);
  ASSERT_NE(at, std::string::npos) << result.out;
  const std::size_t end = result.out.find('\n', at);
  Json scene = Json::parse(slurp(folder_ / "sagging.json"));
  scene["settings"].update(Json::parse(result.out.substr(at + mark.size(), end - at - mark.size())));
  std::ofstream(folder_ / "mended.json") << scene.dump();
  EXPECT_NE(pliant("check mended.json --seconds 600").out.find("nothing wrong, nothing doubtful"), std::string::npos);
}

TEST_F(Command, CheckTellsAMeshItsSizeAndWhatWasMended) {
  std::ofstream(folder_ / "patch.obj") << "v 0 0 0\nv 0 0 20\nv 30 0 0\nv 9 9 9\nf 1 2 3\n";
  const Result result = pliant("check patch.obj");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out.rfind("patch.obj: 3 vertices, 1 triangle, 30 x 0 x 20 m", 0), 0u) << result.out;
  EXPECT_NE(result.out.find("\nrepaired: dropped 1 vertex of no triangle, the first 3\nthe indices below"),
            std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find("\nnote: open, with 1 border of 3 edges"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("doubtful"), std::string::npos) << "a border is right for a cloth:\n" << result.out;
  std::ofstream(folder_ / "patch.json") << R"({"objects": [{"cloth": {"mesh": {"file": "patch.obj"}}}]})";
  EXPECT_NE(pliant("check patch.json").out.find("dropped 1 vertex of no triangle"), std::string::npos);
}

/// Two boxes of 0.2 m x 0.4 m x 0.6 m, 4 m apart along x.
TEST_F(Command, CheckCountsSolidsInTheSize) {
  std::ofstream(folder_ / "boxes.json") << R"({"frames": 1, "objects": [{"name": "boxes", "bodies": [
      {"name": "a", "solids": [{"box": {"half_extents": [0.1, 0.2, 0.3]}}], "position": [0, 0.2, 0]},
      {"name": "b", "solids": [{"box": {"half_extents": [0.1, 0.2, 0.3]}}], "position": [4, 0.2, 0]}]}]})";
  const Result result = pliant("check boxes.json");
  EXPECT_NE(result.out.find("of 2 particles, 4.2 x 0.4 x 0.6 m"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("moves freely"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace pliant
