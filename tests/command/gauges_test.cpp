// Tests what `pliant run` measures of liquids: the table of gauges, and compression in the report.
#include "command_fixture.h"

namespace pliant {
namespace {

/// A block of water in a tank, with a gauge of each kind.
std::string tank(const std::string& settings) {
  return R"({"frames": 3, "settings": {)" + settings + R"(},
    "objects": [{"name": "water", "liquid": {"fill": {"min": [0, 0, 0], "max": [0.4, 0.8, 0.2]}, "spacing": 0.05}}],
    "colliders": [{"name": "floor", "plane": {}},
      {"plane": {}, "rotation": {"axis": [0, 0, 1], "degrees": -90}},
      {"plane": {}, "rotation": {"axis": [0, 0, 1], "degrees": 90}, "position": [0.4, 0, 0]},
      {"plane": {}, "rotation": {"axis": [1, 0, 0], "degrees": 90}},
      {"plane": {}, "rotation": {"axis": [1, 0, 0], "degrees": -90}, "position": [0, 0, 0.2]}],
    "gauges": [{"name": "level, \"all\"", "height": {"min": [0, 0, 0], "max": [0.4, 2, 0.2]}},
      {"name": "gate", "flow": {"corner": [0.2, 0, 0], "side_a": [0, 2, 0], "side_b": [0, 0, 0.2]}},
      {"name": "front", "front": {}}, {"name": "weight", "force": {"on": "floor"}}]})";
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields{""};
  for (const char c : line) {
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

TEST_F(Command, WritesTheGaugesOfEachFrame) {
  std::ofstream(folder_ / "tank.json") << tank("");
  const Result result = pliant("run tank.json --gauges out/g.csv");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("wrote out/g.csv"), std::string::npos) << result.out;
  const std::vector<std::string> lines = lines_of(slurp(folder_ / "out/g.csv"));
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[0], "time [s],\"level, \"\"all\"\" [m]\",gate [m^3/s],front [m],weight [N]");
  const std::vector<std::string> first = fields_of(lines[1]), last = fields_of(lines[4]);
  ASSERT_EQ(first.size(), 5u);
  ASSERT_EQ(last.size(), 5u);
  EXPECT_EQ(first[0], "0");
  EXPECT_NEAR(std::stod(first[1]), 0.8, 1e-6);
  EXPECT_EQ(first[2], "") << "no flow before the first frame";
  EXPECT_NEAR(std::stod(first[3]), 0.396, 1e-6);
  EXPECT_EQ(first[4], "");
  EXPECT_NEAR(std::stod(last[0]), 0.05, 1e-6);
  EXPECT_GT(std::stod(last[4]), 0);
}

TEST_F(Command, RefusesATableOfNoGauges) {
  expect_refused("run small.json --gauges g.csv", 1, "the scene has no gauges to write");
  EXPECT_FALSE(fs::exists(folder_ / "g.csv"));
}

TEST_F(Command, ReportsAndWarnsOfCompression) {
  std::ofstream(folder_ / "fine.json") << tank("");
  std::ofstream(folder_ / "coarse.json") << tank("\"substeps\": 2");
  ASSERT_EQ(pliant("run fine.json --report fine_report.json").out.find("denser"), std::string::npos);
  const Result coarse = pliant("run coarse.json --frames 40 --report coarse_report.json");
  EXPECT_NE(coarse.out.find("denser than at rest on average; use more substeps"), std::string::npos) << coarse.out;
  const Json fine_report = Json::parse(slurp(folder_ / "fine_report.json"));
  EXPECT_LT(fine_report["compression"]["worst_mean"].get<double>(), 0.01);
  EXPECT_GT(fine_report["compression"]["worst_mean"].get<double>(), 0);
  const Json report = Json::parse(slurp(folder_ / "coarse_report.json"));
  EXPECT_GT(report["compression"]["worst_mean"].get<double>(), 0.01);
  EXPECT_GE(report["compression"]["worst_largest"].get<double>(), report["compression"]["worst_mean"].get<double>());
  EXPECT_GT(report["compression"]["frame_of_worst_mean"].get<int>(), 0);
  EXPECT_NE(report["warnings"].dump().find("denser than at rest"), std::string::npos);
  ASSERT_EQ(pliant("run small.json --report none.json --quiet").status, 0);
  EXPECT_TRUE(Json::parse(slurp(folder_ / "none.json"))["compression"].is_null());
}

TEST_F(Command, WritesTheSurfaceOfALiquid) {
  std::ofstream(folder_ / "tank.json") << tank("");
  ASSERT_EQ(pliant("run tank.json --out s.ply --liquid-surfaces --quiet").status, 0);
  EXPECT_EQ(slurp(folder_ / "s_0003.ply").find("element face 0\n"), std::string::npos);
  ASSERT_EQ(pliant("run tank.json --out p.ply --quiet").status, 0);
  EXPECT_NE(slurp(folder_ / "p_0003.ply").find("element face 0\n"), std::string::npos);
  expect_refused("run tank.json --out s.glb --liquid-surfaces", 1, "is the surface of a liquid");
}

TEST_F(Command, ACheckSaysNothingOfSweepsOfALiquid) {
  std::ofstream(folder_ / "tank.json") << tank("");
  const Result result = pliant("check tank.json --seconds 0");
  EXPECT_EQ(result.status, 0) << result.out;
  EXPECT_NE(result.out.find("liquids and grains need no sweep"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("linked particles"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace pliant
