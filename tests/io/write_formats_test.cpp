// Reads every format by a reader of its own, and compares with the frames that were written.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "glb_support.h"
#include "read_back_support.h"
#include "write_support.h"

namespace pliant {
namespace {

using nlohmann::json;
using test::array;
using test::Folder;
using test::Glb;
using test::Obj;
using test::occurrences;
using test::read_obj;
using test::value_at;

/// All positions of a frame, object after object.
std::vector<Vec3f> joined(const output::Frame& frame) {
  std::vector<Vec3f> result;
  for (const auto& positions : frame.positions) result.insert(result.end(), positions.begin(), positions.end());
  return result;
}

TEST(ObjSequence, HoldsEveryFrame) {
  const Folder folder;
  test::write_sample(folder / "run.obj", 3);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"run_0000.obj", "run_0001.obj", "run_0002.obj"}));
  const Obj obj = read_obj(folder / "run_0002.obj");
  EXPECT_EQ(obj.vertices, joined(test::sample_frame(2)));
  EXPECT_EQ(obj.faces, (std::vector<std::vector<int>>{{1, 2, 3}, {2, 4, 3}}));
  EXPECT_EQ(obj.lines, (std::vector<std::vector<int>>{{5, 7, 6}}));
  EXPECT_EQ(obj.points, (std::vector<std::vector<int>>{{8}, {9}}));
  EXPECT_EQ(obj.objects, (std::vector<std::string>{"a__sheet_____more_", "rope", "rope_2"}));
}

TEST(PlySequence, HoldsEveryFrame) {
  const Folder folder;
  test::write_sample(folder / "run.ply", 2);
  const std::string bytes = test::read(folder / "run_0001.ply");
  const std::string end = "end_header\n";
  const std::size_t body = bytes.find(end) + end.size();
  const std::string header = bytes.substr(0, body);
  EXPECT_NE(header.find("element vertex 9\n"), std::string::npos);
  EXPECT_NE(header.find("element face 2\n"), std::string::npos);
  EXPECT_NE(header.find("element edge 2\n"), std::string::npos);
  const std::vector<Vec3f> expected = joined(test::sample_frame(1));
  constexpr std::size_t vertex = 12 + 3 + 4;
  ASSERT_EQ(bytes.size(), body + 9 * vertex + 2 * 13 + 2 * 8);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(value_at<Vec3f>(bytes, body + i * vertex), expected[i]);
    EXPECT_EQ(value_at<int>(bytes, body + i * vertex + 15), i < 4 ? 0 : i < 7 ? 1 : 2);
  }
  EXPECT_EQ(value_at<unsigned char>(bytes, body + 12), 188);  // 0.5 in sRGB
  const std::size_t faces = body + 9 * vertex;
  EXPECT_EQ(bytes[faces + 13], 3);
  EXPECT_EQ(value_at<int>(bytes, faces + 13 + 5), 3);
  EXPECT_EQ(value_at<int>(bytes, faces + 26), 4);  // the rope's first edge
}

TEST(Pc2, HoldsEverySampleBesideItsMesh) {
  const Folder folder;
  test::write_sample(folder / "run.pc2", 3);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"run.obj", "run.pc2"}));
  const std::string bytes = test::read(folder / "run.pc2");
  EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2", 12));
  EXPECT_EQ(value_at<int>(bytes, 12), 1);
  EXPECT_EQ(value_at<int>(bytes, 16), 9);
  EXPECT_EQ(value_at<float>(bytes, 20), 0);
  EXPECT_EQ(value_at<float>(bytes, 24), 1);
  EXPECT_EQ(value_at<int>(bytes, 28), 3);
  ASSERT_EQ(bytes.size(), 32u + 3 * 9 * 12);
  for (int k = 0; k < 3; ++k) {
    const std::vector<Vec3f> expected = joined(test::sample_frame(k));
    for (std::size_t i = 0; i < 9; ++i)
      EXPECT_EQ(value_at<Vec3f>(bytes, 32 + (static_cast<std::size_t>(k) * 9 + i) * 12), expected[i]);
  }
  const Obj obj = read_obj(folder / "run.obj");
  EXPECT_EQ(obj.vertices, joined(test::sample_frame(0)));
  EXPECT_TRUE(obj.objects.empty());
  EXPECT_EQ(obj.groups.size(), 3u);
}

/// Expects the bounds of an accessor to be exactly those of its values.
void expect_exact_bounds(const Glb& glb, std::size_t index) {
  const std::vector<Vec3f> values = glb.read<Vec3f>(index);
  Vec3f low = values[0], high = values[0];
  for (const Vec3f& v : values) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  const json& accessor = glb.document["accessors"][index];
  EXPECT_EQ(accessor["min"].get<std::vector<float>>(), (std::vector<float>{low.x, low.y, low.z}));
  EXPECT_EQ(accessor["max"].get<std::vector<float>>(), (std::vector<float>{high.x, high.y, high.z}));
}

TEST(Glb, HoldsEveryFrameAsATarget) {
  const Folder folder;
  test::write_sample(folder / "run.glb", 4);
  const Glb glb(folder / "run.glb");
  ASSERT_EQ(glb.document["meshes"].size(), 3u);
  EXPECT_EQ(glb.document["nodes"][0]["name"], "a <sheet> & \"more\"");
  for (std::size_t o = 0; o < 3; ++o) {
    const json& primitive = glb.document["meshes"][o]["primitives"][0];
    EXPECT_EQ(primitive["mode"], (std::vector<int>{4, 1, 0})[o]);
    ASSERT_EQ(primitive["targets"].size(), 3u);
    const std::size_t base_index = primitive["attributes"]["POSITION"];
    const std::vector<Vec3f> base = glb.read<Vec3f>(base_index);
    EXPECT_EQ(base, test::sample_frame(0).positions[o]);
    expect_exact_bounds(glb, base_index);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t index = primitive["targets"][k]["POSITION"];
      std::vector<Vec3f> moved = glb.read<Vec3f>(index);
      expect_exact_bounds(glb, index);
      for (std::size_t i = 0; i < moved.size(); ++i) {
        const Vec3f error = moved[i] + base[i] - test::sample_frame(static_cast<int>(k) + 1).positions[o][i];
        EXPECT_LT(length_squared(error), 1e-10f);
      }
    }
  }
}

TEST(Glb, AnimatesOneWeightAFrame) {
  const Folder folder;
  test::write_sample(folder / "run.glb", 4);
  const Glb glb(folder / "run.glb");
  const json& animation = glb.document["animations"][0];
  EXPECT_EQ(animation["channels"].size(), 3u);
  const std::vector<float> times = glb.read<float>(animation["samplers"][0]["input"].get<std::size_t>());
  ASSERT_EQ(times.size(), 4u);
  EXPECT_FLOAT_EQ(times[3], 3 / 60.f);
  const std::vector<float> weights = glb.read<float>(animation["samplers"][0]["output"].get<std::size_t>());
  EXPECT_EQ(weights, (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
}

TEST(Glb, HasIndicesAndUnitNormals) {
  const Folder folder;
  test::write_sample(folder / "run.glb", 2);
  const Glb glb(folder / "run.glb");
  const json& primitive = glb.document["meshes"][0]["primitives"][0];
  EXPECT_EQ(glb.read<unsigned>(primitive["indices"].get<std::size_t>()), (std::vector<unsigned>{0, 1, 2, 1, 3, 2}));
  for (const Vec3f& n : glb.read<Vec3f>(primitive["attributes"]["NORMAL"].get<std::size_t>()))
    EXPECT_NEAR(length_squared(n), 1, 1e-6);
  EXPECT_EQ(glb.document["meshes"][1]["primitives"][0]["attributes"].count("NORMAL"), 0u);
}

TEST(Glb, NeedsNoAnimationForOneFrame) {
  const Folder folder;
  test::write_sample(folder / "run.glb", 1);
  const Glb glb(folder / "run.glb");
  EXPECT_EQ(glb.document.count("animations"), 0u);
  EXPECT_EQ(glb.document["meshes"][0].count("weights"), 0u);
}

TEST(Usda, NamesTheRateThatWasMeantByAFloat) {
  const Folder folder;
  const std::string path = folder / "run.usda";
  for (const auto& [seconds, rate] : {std::pair{1.f / 60, "60"}, {1.f / 24, "24"}, {1001.f / 30000, "29.97003"}}) {
    const auto writer = output::make_format_writer(path, test::sample_objects(), static_cast<double>(seconds));
    writer->add(test::sample_frame(0));
    writer->finish();
    EXPECT_NE(test::read(path).find("timeCodesPerSecond = " + std::string(rate)), std::string::npos) << rate;
  }
}

TEST(Usda, IsBalancedAndHoldsEverySample) {
  const Folder folder;
  test::write_sample(folder / "run.usda", 3);
  const std::string text = test::read(folder / "run.usda");
  EXPECT_EQ(text.substr(0, 10), "#usda 1.0\n");
  for (const auto& [open, close] : {std::pair{'{', '}'}, {'[', ']'}, {'(', ')'}})
    EXPECT_EQ(std::count(text.begin(), text.end(), open), std::count(text.begin(), text.end(), close)) << open;
  EXPECT_NE(text.find("endTimeCode = 2\n"), std::string::npos);
  EXPECT_NE(text.find("timeCodesPerSecond = 60\n"), std::string::npos);
  EXPECT_NE(text.find("def Mesh \"a__sheet_____more_\""), std::string::npos);
  EXPECT_NE(text.find("def BasisCurves \"rope\""), std::string::npos);
  EXPECT_NE(text.find("def Points \"rope_2\""), std::string::npos);
  EXPECT_NE(text.find("uniform bool doubleSided = 1"), std::string::npos);
  EXPECT_NE(text.find("faceVertexCounts = [3, 3]"), std::string::npos);
  EXPECT_NE(text.find("faceVertexIndices = [0, 1, 2, 1, 3, 2]"), std::string::npos);
  EXPECT_NE(text.find("curveVertexCounts = [3]"), std::string::npos);
  EXPECT_EQ(occurrences(text, "points.timeSamples"), 3);
  EXPECT_EQ(occurrences(text, "extent.timeSamples"), 3);
  EXPECT_NE(text.find("2: [(0, 2, 0), (1, 2, 0), (0, 2, 1), (1, 2.1, 1)],"), std::string::npos);
  EXPECT_NE(text.find("2: [(0, 2, 0), (1, 2.1, 1)],"), std::string::npos);           // extent of the sheet
  EXPECT_NE(text.find("2: [(0, 2, 0), (4, 0, 0), (2, 1, 0)],"), std::string::npos);  // positions along the rope
}

/// A minimal XML check: tags nest, attributes are quoted, text has no stray characters.
testing::AssertionResult well_formed(const std::string& text) {
  std::vector<std::string> open;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] != '<') {
      if (text[at] == '>' || text[at] == '&') return testing::AssertionFailure() << "a stray sign at byte " << at;
      ++at;
      continue;
    }
    std::size_t end = at + 1;
    for (bool inside = false; end < text.size() && (inside || text[end] != '>'); ++end) {
      if (text[end] == '"') inside = !inside;
      if (text[end] == '<') return testing::AssertionFailure() << "< within a tag at byte " << end;
    }
    const std::string tag = text.substr(at + 1, end - at - 1);
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1))
        return testing::AssertionFailure() << "</" << tag << " closes nothing";
      open.pop_back();
    } else if (tag[0] != '?' && tag.back() != '/') {
      open.push_back(tag.substr(0, tag.find(' ')));
    }
    at = end + 1;
  }
  if (!open.empty()) return testing::AssertionFailure() << open.back() << " is not closed";
  return testing::AssertionSuccess();
}

TEST(Vtp, HoldsEveryFrameAndObject) {
  const Folder folder;
  test::write_sample(folder / "run.pvd", 2);
  const std::string list = test::read(folder / "run.pvd");
  EXPECT_TRUE(well_formed(list));
  EXPECT_EQ(occurrences(list, "<DataSet "), 6);
  EXPECT_NE(list.find("file=\"run/a__sheet_____more__0001.vtp\""), std::string::npos);
  const std::string sheet = test::read(folder / "run/a__sheet_____more__0001.vtp");
  EXPECT_TRUE(well_formed(sheet));
  EXPECT_NE(sheet.find("NumberOfPoints=\"4\""), std::string::npos);
  EXPECT_NE(sheet.find("NumberOfPolys=\"2\""), std::string::npos);
  const std::string points = array(sheet, "Points"), velocities = array(sheet, "velocity");
  const std::string corners = array(sheet, "connectivity"), offsets = array(sheet, "offsets");
  ASSERT_EQ(points.size(), 48u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(value_at<Vec3f>(points, 12 * i), test::sample_frame(1).positions[0][i]);
  EXPECT_EQ(value_at<Vec3f>(velocities, 12), (Vec3f{0, 60, 0}));
  ASSERT_EQ(corners.size(), 48u);
  EXPECT_EQ(value_at<std::int64_t>(corners, 32), 3);
  EXPECT_EQ(value_at<std::int64_t>(offsets, 8), 6);
}

TEST(Vtp, WritesLinesAndPoints) {
  const Folder folder;
  test::write_sample(folder / "run.pvd", 1);
  const std::string rope = test::read(folder / "run/rope_0000.vtp"),
                    points = test::read(folder / "run/rope_2_0000.vtp");
  EXPECT_TRUE(well_formed(rope));
  EXPECT_TRUE(well_formed(points));
  EXPECT_NE(rope.find("NumberOfLines=\"1\""), std::string::npos);
  EXPECT_EQ(value_at<std::int64_t>(array(rope, "offsets"), 0), 3);
  EXPECT_NE(points.find("NumberOfVerts=\"2\""), std::string::npos);
}

}  // namespace
}  // namespace pliant
