// Tests the gauges of scene files: every field, and what is refused with its place.
#include <gtest/gtest.h>

#include "pliant/error.h"
#include "pliant/io.h"
#include "scene_support.h"
#include "write_support.h"

namespace pliant {
namespace {

TEST(SceneGauges, HaveEveryField) {
  const test::Folder folder;
  test::put(folder / "all.json", test::full_scene());
  const std::vector<Gauge> gauges = read_scene_file(folder / "all.json").gauges;
  ASSERT_EQ(gauges.size(), 7u);
  EXPECT_EQ(gauges[0].name, "wall");
  EXPECT_EQ(gauges[0].liquids, (std::vector<std::string>{"oil", "drops"}));
  const auto& wall = std::get<HeightGauge>(gauges[0].measures);
  EXPECT_EQ(wall.low, (Vec3f{-8, 4, 1}));
  EXPECT_EQ(wall.high, (Vec3f{-7, 5, 2}));
  EXPECT_EQ(wall.axis, 2);
  EXPECT_EQ(std::get<HeightGauge>(gauges[1].measures).axis, 1);
  EXPECT_TRUE(gauges[1].liquids.empty());
  const auto& gate = std::get<FlowGauge>(gauges[2].measures);
  EXPECT_EQ(gate.corner, (Vec3f{-8, 4, 1}));
  EXPECT_EQ(gate.side_a, (Vec3f{0, 2, 0}));
  EXPECT_EQ(gate.side_b, (Vec3f{0, 0, 3}));
  const auto& tip = std::get<FrontGauge>(gauges[3].measures);
  EXPECT_EQ(tip.direction, (Vec3f{0, 0, 2}));
  EXPECT_EQ(tip.share, 0.75f);
  EXPECT_EQ(std::get<FrontGauge>(gauges[4].measures).share, 0.99f);
  const auto& load = std::get<ForceGauge>(gauges[5].measures);
  EXPECT_EQ(load.on, "floor");
  EXPECT_EQ(load.direction, (Vec3f{1, 0, 0}));
  EXPECT_EQ(std::get<ForceGauge>(gauges[6].measures).direction, (Vec3f{0, -1, 0}));
}

std::string refusal(const std::string& gauges, const std::string& liquid = "liquid") {
  const std::string text =
      R"({"objects": [{"name": "water", ")" + liquid +
      R"(": {"positions": [[0, 0, 0]]}}], "colliders": [{"name": "floor", "plane": {}}], "gauges": [)" + gauges + "]}";
  try {
    parse_scene(text, "s.json", ".");
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing is refused";
}

TEST(SceneGauges, RefuseWhatCannotBeMeasured) {
  const auto says = [](const std::string& gauges, const std::string& words) {
    EXPECT_NE(refusal(gauges).find(words), std::string::npos) << refusal(gauges);
  };
  EXPECT_EQ(refusal(R"({"name": "a", "front": {}})"), "nothing is refused");
  says(R"({"name": "a", "front": {}}, {"name": "a", "front": {}})", "/gauges/1/name: is taken by another gauge");
  says(R"({"name": "", "front": {}})", "/gauges/0/name: this string is empty");
  says(R"({"name": "a", "front": {"direction": [0, 0, 0]}})", "/gauges/0/front/direction: is a direction of no length");
  says(R"({"name": "a", "front": {"share": 1}})", "/gauges/0/front/share: is not between 0 and 1");
  says(R"({"name": "a", "height": {"min": [0, 0, 0], "max": [1, 0, 1]}})", "/gauges/0/height/max: is not above 'min'");
  says(R"({"name": "a", "flow": {"corner": [0, 0, 0], "side_a": [1, 0, 0], "side_b": [2, 0, 0]}})", "spans no area");
  says(R"({"name": "a", "force": {"on": "roof"}})", "'roof' does not exist");
  says(R"({"name": "a", "force": {"on": "water"}})", "or is a liquid");
  says(R"({"name": "a", "front": {}, "liquids": ["oil"]})", "/gauges/0/liquids/0: there is no liquid 'oil'");
  says(R"({"name": "a", "front": {}, "force": {"on": "floor"}})", "exactly one of");
  EXPECT_NE(refusal(R"({"name": "a", "front": {}})", "grains").find("no liquid to measure"), std::string::npos);
}

}  // namespace
}  // namespace pliant
