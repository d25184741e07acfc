// Tests `pliant compare`.
#include <algorithm>
#include <fstream>
#include <string>

#include "command/command_fixture.h"

namespace pliant {
namespace {

TEST_F(Command, CompareShowsEverySweepAndWritesPictureAndNumbers) {
  const Result result = pliant("compare small.json --iterations 3 --out curves.png --out curves.json");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("small.json after 2 frames"), std::string::npos) << result.out;
  for (const char* sweep : {"\ntiled ", "\nsymmetric ", "\njacobi ", "\nnatural ", "\nchains ", "\ntiled+chebyshev "})
    EXPECT_NE(result.out.find(sweep), std::string::npos) << sweep << result.out;
  EXPECT_NE(result.out.find("; its curve is that of its sweep, and --budget-ms runs it too\n"), std::string::npos)
      << result.out;
  EXPECT_EQ(result.out.find("almost at rest"), std::string::npos) << result.out;
  EXPECT_EQ(slurp(folder_ / "curves.png").substr(1, 3), "PNG");
  const Json json = Json::parse(slurp(folder_ / "curves.json"));
  EXPECT_EQ(json.at("iterations"), 3);
  EXPECT_GE(json.at("curves").size(), 6u);
  const Result few = pliant(
      "compare small.json --iterations 2 --sweeps tiled,natural+chebyshev --frame 1 --frames 2 --budget-ms 100000");
  EXPECT_EQ(few.status, 0) << few.err;
  EXPECT_NE(few.out.find("left out: natural+chebyshev: "), std::string::npos) << few.out;
  EXPECT_NE(few.out.find("within 100000 ms per frame, 2 frames"), std::string::npos) << few.out;
}

TEST_F(Command, CompareSaysThatASceneIsAtRest) {
  Json scene = Json::parse(small_scene(4));
  scene["gravity"] = {0, 0, 0};
  std::ofstream(folder_ / "small.json") << scene.dump();
  const std::string out = pliant("compare small.json --iterations 2 --sweeps tiled").out;
  EXPECT_NE(out.find("the scene is almost at rest there, at 0 m/s in the mean: choose a --frame in motion\n"),
            std::string::npos)
      << out;
}

TEST_F(Command, CompareRefusesWhatItCannotDo) {
  expect_refused("compare", 2, "SCENE");
  expect_refused("compare small.json --iterations 0", 2, "iterations");
  expect_refused("compare small.json --budget-ms -1", 2, "budget-ms");
  expect_refused("compare small.json --sweeps tilde", 1, "tilde");
  expect_refused("compare small.json --sweeps natural+chebyshev", 1, "natural order");
  expect_refused("compare small.json --out curves.gif", 1, "curves.gif");
  expect_refused("compare small.json --out small.json", 1, "twice");
  expect_refused("compare small.json --out a.png --out b.png", 1, "b.png");
  expect_refused("compare small.json --out nowhere/a.json", 1, "nowhere");
  expect_refused("compare small.json --frames 0 --budget-ms 1", 1, "--frames");
  EXPECT_EQ(slurp(folder_ / "small.json"), small_scene(4)) << "what was read is written over";
  EXPECT_EQ(files(), 1) << "an error left a file behind";
}

}  // namespace
}  // namespace pliant
