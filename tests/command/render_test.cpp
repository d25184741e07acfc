// Tests pliant render: where the camera is, drafts, and pictures of checkpoints.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "command/command_fixture.h"

namespace pliant {
namespace {

/// Draws small.json and returns the bytes of the file.
class Render : public Command {
 protected:
  std::string draw(const std::string& arguments, const std::string& name = "a.png") {
    const Result result = pliant("render small.json --quiet --out " + name + " " + arguments);
    EXPECT_EQ(result.status, 0) << arguments << ": " << result.err;
    return slurp(folder_ / name);
  }
};

TEST_F(Render, RefusesCamerasThatSeeNothing) {
  expect_refused("render small.json --out a.png --look-at 1,2", 2, "--look-at");
  expect_refused("render small.json --out a.png --look-at 1,2,x", 2, "--look-at");
  expect_refused("render small.json --out a.png --distance 0", 2, "--distance");
  expect_refused("render small.json --out a.png --fov 180", 2, "--fov");
}

TEST_F(Render, TheCameraIsWhereItIsTold) {
  if (const std::string why = why_nothing_is_drawn(); !why.empty()) GTEST_SKIP() << why;
  const std::string plain = draw("--size 160x120");
  EXPECT_TRUE(draw("--size 160x120 --fov 30") == plain) << "the default";
  for (const char* other : {"--look-at 0.2,0,0", "--distance 4", "--fov 50"})
    EXPECT_FALSE(draw(std::string("--size 160x120 ") + other) == plain) << other;
}

TEST_F(Render, TheSceneHasACameraThatOptionsOverride) {
  if (const std::string why = why_nothing_is_drawn(); !why.empty()) GTEST_SKIP() << why;
  const std::string size = "--size 160x120 ";
  const auto from = [&](const std::string& camera, const std::string& options = "") {
    return draw(size + "--set '/camera=" + camera + "' " + options);
  };
  const std::string plain = draw(size);
  EXPECT_TRUE(from("{}") == plain);
  EXPECT_TRUE(from(R"({"azimuth": 70, "elevation": 40, "distance": 3, "fov": 50, "look_at": [0, 0.1, 0]})") ==
              draw(size + "--azimuth 70 --elevation 40 --distance 3 --fov 50 --look-at 0,0.1,0"));
  EXPECT_TRUE(from(R"({"azimuth": 70, "fov": 50})", "--azimuth 28") == draw(size + "--fov 50"));
  EXPECT_FALSE(from(R"({"position": [1, 2, 1]})") == plain);
  EXPECT_TRUE(from(R"({"position": [0, 0, 3], "look_at": [0, 0, 0]})") ==
              draw(size + "--azimuth 0 --elevation 0 --distance 3 --look-at 0,0,0"));
}

TEST_F(Render, DrawsACheckpointAndGoesOnFromIt) {
  if (const std::string why = why_nothing_is_drawn(); !why.empty()) GTEST_SKIP() << why;
  ASSERT_EQ(pliant("run small.json --frames 2 --checkpoint two.state --quiet").status, 0);
  EXPECT_TRUE(draw("--size 160x120 --resume two.state") == draw("--size 160x120 --frame 2"));
  EXPECT_TRUE(draw("--size 160x120 --resume two.state --frame 4") == draw("--size 160x120 --frame 4"));
  expect_refused("render small.json --out a.png --resume two.state --frame 1", 1, "two.state: is of frame 2");
  expect_refused("render small.json --out a.mp4 --resume two.state", 1, "--resume");
  expect_refused("render small.json --out a.png --resume small.json", 1, "small.json");
}

TEST_F(Render, DrawsTheFramesOfAGlb) {
  if (const std::string why = why_nothing_is_drawn(); !why.empty()) GTEST_SKIP() << why;
  ASSERT_EQ(pliant("run small.json --out small.glb --quiet").status, 0);
  const auto draw_glb = [&](const std::string& arguments) {
    const Result result = pliant("render small.glb --quiet --out a.png --size 160x120 " + arguments);
    EXPECT_EQ(result.status, 0) << arguments << ": " << result.err;
    return slurp(folder_ / "a.png");
  };
  const std::string last = draw_glb("");
  EXPECT_TRUE(draw_glb("--frame 4") == last);
  EXPECT_FALSE(draw_glb("--frame 0") == last);
  EXPECT_FALSE(draw_glb("--azimuth 80") == last);
  EXPECT_FALSE(draw_glb("--strip 0,4") == last);
  expect_refused("render small.glb --out a.png --frame 5", 1, "small.glb: has no frame 5; its last one is 4");
  expect_refused("render small.glb --out a.png --strip 0,9", 1, "small.glb: has no frame 9");
  expect_refused("render small.glb --out a.png --resume a.state", 1, "--resume");
  std::ofstream(folder_ / "damaged.glb") << "glTF";
  expect_refused("render damaged.glb --out a.png", 1, "damaged.glb: is no .glb file");
  expect_refused("render none.glb --out a.png", 1, "none.glb");
}

TEST_F(Render, ADraftIsSmaller) {
  if (const std::string why = why_nothing_is_drawn(); !why.empty()) GTEST_SKIP() << why;
  const std::string draft = draw("--draft");
  ASSERT_GT(draft.size(), 24u);
  EXPECT_EQ(draft.substr(16, 8), std::string("\0\0\2\x80\0\0\1\x68", 8)) << "640 x 360 in the header of the file";
  EXPECT_EQ(draw("--draft --size 200x50").substr(16, 8), std::string("\0\0\0\xc8\0\0\0\x32", 8));
}

}  // namespace
}  // namespace pliant
