// Tests of .glb files of other programs, written here byte by byte: how keys are mixed, what frames there are, how large
// points and lines are drawn, and which trees of nodes are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "io/write_support.h"
#include "pliant/error.h"
#include "render/glb.h"

namespace pliant::render {
namespace {

std::string word(std::size_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  std::string bytes(sizeof bits, '\0');
  std::memcpy(bytes.data(), &bits, sizeof bits);
  return bytes;
}

std::string list_of(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ",") + item;
  return "[" + text + "]";
}

/// A .glb file in the making: arrays are accessors 0, 1, ... in the order of `add`.
class GlbText {
 public:
  void add(const char* type, std::size_t parts, const std::vector<float>& values) {
    const std::size_t size = 4 * values.size();
    views_.push_back(R"({"buffer": 0, "byteOffset": )" + std::to_string(binary_.size()) + R"(, "byteLength": )" +
                     std::to_string(size) + "}");
    accessors_.push_back(R"({"bufferView": )" + std::to_string(accessors_.size()) +
                         R"(, "componentType": 5126, "type": ")" + type + R"(", "count": )" +
                         std::to_string(values.size() / parts) + "}");
    const std::size_t at = binary_.size();
    binary_.resize(at + size);
    std::memcpy(&binary_[at], values.data(), size);
  }
  void add_points(const std::vector<float>& values) { add("VEC3", 3, values); }
  void add_numbers(const std::vector<float>& values) { add("SCALAR", 1, values); }
  void add_rotations(const std::vector<float>& values) { add("VEC4", 4, values); }

  /// `members`: "nodes" and more.
  void write(const std::string& path, const std::string& members) const {
    std::string text = R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": )" + std::to_string(binary_.size()) +
                       R"(}], "bufferViews": )" + list_of(views_) + R"(, "accessors": )" + list_of(accessors_) + ", " +
                       members + "}";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string binary = binary_;
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::ofstream(path, std::ios::binary)
        << "glTF" << word(2) << word(28 + text.size() + binary.size()) << word(text.size()) << "JSON" << text
        << word(binary.size()) << std::string("BIN\0", 4) << binary;
  }

 private:
  std::vector<std::string> views_, accessors_;
  std::string binary_;
};

class GlbOfOthers : public testing::Test {
 protected:
  std::string refusal() const {
    try {
      (void)GlbFile(path_).frame(0);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  const test::Folder folder_;
  const std::string path_ = folder_ / "b.glb";
  GlbText glb_;
};

/// Eight points at the corners of a cube of 1 m.
std::vector<float> cube_corners() {
  std::vector<float> values;
  for (int i = 0; i < 8; ++i)
    for (const int side : {i & 1, i >> 1 & 1, i >> 2}) values.push_back(static_cast<float>(side));
  return values;
}

TEST_F(GlbOfOthers, NodesInTwoPlacesAreRefused) {
  glb_.add_points(cube_corners());
  std::string nodes;
  for (int i = 1; i <= 40; ++i) {
    const std::string next = std::to_string(i);
    nodes += R"({"children": [)" + next + ", " + next + "]}, ";
  }
  const auto write = [&](const std::string& list) {
    glb_.write(path_, R"("scenes": [{"nodes": [0]}], "meshes": [], "nodes": [)" + list + "]");
  };
  write(nodes + "{}");  // 2^40 visits
  EXPECT_NE(refusal().find("has node 40 in two places"), std::string::npos) << refusal();
  write(R"({"children": [1]}, {"children": [0]})");
  EXPECT_NE(refusal().find("has node 0 in two places"), std::string::npos) << refusal();
}

TEST_F(GlbOfOthers, JsonNestedDeeplyIsRefused) {
  const auto write = [&](std::size_t depth) {
    glb_.write(path_, R"("scenes": [{"nodes": []}], "extras": )" + std::string(depth, '[') + std::string(depth, ']'));
  };
  write(60);
  EXPECT_EQ(refusal(), "");
  for (const std::size_t depth : {65, 200000}) {
    write(depth);
    EXPECT_NE(refusal().find("nested deeper than 64"), std::string::npos) << refusal();
  }
}

TEST_F(GlbOfOthers, RotationsAreMixedTheShortWay) {
  glb_.add_points({1, 0, 0});
  glb_.add_numbers({0, 1, 2});
  const float c = std::cos(0.1f), s = std::sin(0.1f);  // 0.2 rad about y, there and back, each with the other sign
  glb_.add_rotations({0, s, 0, c, 0, s, 0, -c, 0, s, 0, c});
  glb_.add_numbers({0, 0.5f, 1, 1.5f, 2});
  glb_.add_points(std::vector<float>(15, 0));
  glb_.write(path_, R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"mode": 0, "attributes": {"POSITION": 0}}]}],
    "animations": [{"samplers": [{"input": 1, "output": 2}, {"input": 3, "output": 4}],
      "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}},
                   {"sampler": 1, "target": {"node": 0, "path": "translation"}}]}])");
  const GlbFile file(path_);
  ASSERT_EQ(file.last_frame(), 4);
  for (int frame = 0; frame <= 4; ++frame) {
    const Vec3f x = file.frame(frame).balls.at(0).centres.at(0);
    const float angle = frame % 4 == 0 ? 0.2f : frame == 2 ? -0.2f : 0;
    EXPECT_NEAR(std::atan2(-x.z, x.x), angle, 1e-5f) << frame;
  }
}

TEST_F(GlbOfOthers, FramesAreAtTheKeysOfAllChannels) {
  glb_.add_points({1, 0, 0});
  glb_.add_numbers({0, 0.25f, 0.5f});
  glb_.add_points(std::vector<float>(9, 1));
  glb_.add_numbers({0.5f, 2});
  glb_.add_points({0, 0, 0, 3, 0, 0});
  glb_.write(path_, R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"mode": 0, "attributes": {"POSITION": 0}}]}],
    "animations": [{"samplers": [{"input": 1, "output": 2}, {"input": 3, "output": 4}],
      "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}},
                   {"sampler": 1, "target": {"node": 0, "path": "translation"}}]}])");
  const GlbFile file(path_);
  ASSERT_EQ(file.last_frame(), 3) << "0, 0.25, 0.5 and 2 s";
  EXPECT_NEAR(file.frame(3).balls.at(0).centres.at(0).x, 4, 1e-6f);
  EXPECT_NEAR(file.frame_time(), 2.0 / 3, 1e-6);
}

/// Points or lines in a node that is `scale` times as large; the radius with which they are drawn.
float radius_of(const RenderScene& scene) {
  return scene.balls.empty() ? scene.tubes.at(0).radius : scene.balls.at(0).radius;
}

TEST_F(GlbOfOthers, RadiiFollowTheScaleOfNodes) {
  glb_.add_points(cube_corners());
  for (const char* mode : {"0", "1", "3"}) {
    const auto radius = [&](const char* around, const char* scale) {
      glb_.write(path_, std::string(R"("scenes": [{"nodes": [0]}], "nodes": [{"children": [1], "scale": [)") + around +
                            R"(]}, {"mesh": 0, "scale": [)" + scale +
                            R"(]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": )" + mode +
                            "}]}]");
      return radius_of(GlbFile(path_).frame(0));
    };
    const float own = radius("1, 1, 1", "1, 1, 1");
    EXPECT_GT(own, 0);
    EXPECT_NEAR(radius("5, 5, 5", "0.1, 0.1, -0.1"), 0.5f * own, 1e-5f * own) << mode;
    EXPECT_NEAR(radius("1, 1, 1", "100, 100, 100"), 100 * own, 1e-3f * own) << mode;
  }
}

TEST_F(GlbOfOthers, LinesKeepTheirRadiusAndWeightsThatStayAreUsed) {
  glb_.add_points({0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0});
  glb_.add_points({0, 0, 0, 4, 0, 0, 8, 0, 0, 12, 0, 0});
  const auto drawn = [&](const std::string& of_node, const std::string& of_mesh) {
    glb_.write(path_, R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0)" + of_node +
                          R"(}], "meshes": [{"primitives": [{"mode": 1, "attributes": {"POSITION": 0},
                             "targets": [{"POSITION": 1}]}])" +
                          of_mesh + "}]");
    return GlbFile(path_).frame(0);
  };
  const RenderScene at_rest = drawn("", "");
  ASSERT_EQ(at_rest.tubes.size(), 2u);
  EXPECT_EQ(at_rest.tubes[1].points.back().x, 3);
  for (const RenderScene& scene : {drawn(R"(, "weights": [0.5])", ""), drawn("", R"(, "weights": [0.5])"),
                                   drawn(R"(, "weights": [0.5])", R"(, "weights": [9])")}) {
    EXPECT_EQ(scene.tubes.at(1).points.back().x, 9);
    EXPECT_EQ(radius_of(scene), radius_of(at_rest));
  }
}

}  // namespace
}  // namespace pliant::render
