// Reads the lines of a rope that broke out of files of every format.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "glb_support.h"
#include "pliant/io.h"
#include "pliant/world.h"
#include "read_back_support.h"
#include "write_support.h"

namespace pliant {
namespace {

using nlohmann::json;
using test::array;
using test::Folder;
using test::Glb;
using test::Obj;
using test::read_obj;
using test::value_at;

using Segments = std::vector<std::array<Vec3f, 2>>;

/// Those of lines, each of which is given by its points, but for those without length.
void add_segments(const std::vector<Vec3f>& line, Segments& segments) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    if (line[i] != line[i + 1]) segments.push_back({line[i], line[i + 1]});
}

Segments segments_of(const Obj& obj, const std::vector<Vec3f>& vertices) {
  Segments out;
  for (const std::vector<int>& line : obj.lines) {
    std::vector<Vec3f> points;
    for (const int i : line) points.push_back(vertices.at(static_cast<std::size_t>(i) - 1));
    add_segments(points, out);
  }
  return out;
}

Segments segments_in_ply(const std::string& bytes) {
  const auto count = [&](const std::string& what) {
    return static_cast<std::size_t>(std::stoi(bytes.substr(bytes.find("element " + what) + what.size() + 9)));
  };
  const std::size_t body = bytes.find("end_header\n") + 11, edges = bytes.size() - 8 * count("edge");
  const std::size_t vertex = (edges - body) / count("vertex");
  const auto end_at = [&](std::size_t at) {
    return value_at<Vec3f>(bytes, body + vertex * static_cast<std::size_t>(value_at<int>(bytes, at)));
  };
  Segments out;
  for (std::size_t at = edges; at < bytes.size(); at += 8) add_segments({end_at(at), end_at(at + 4)}, out);
  return out;
}

Segments segments_in_vtp(const std::string& text) {
  const std::string points = array(text, "Points"), corners = array(text, "connectivity"),
                    ends = array(text, "offsets");
  Segments out;
  std::size_t at = 0;
  for (std::size_t i = 0; i < ends.size(); i += 8) {
    std::vector<Vec3f> line;
    for (; at < 8 * static_cast<std::size_t>(value_at<std::int64_t>(ends, i)); at += 8)
      line.push_back(value_at<Vec3f>(points, 12 * static_cast<std::size_t>(value_at<std::int64_t>(corners, at))));
    add_segments(line, out);
  }
  return out;
}

/// The numbers of the last time sample of an attribute.
std::vector<float> last_sample(const std::string& text, const std::string& attribute) {
  const std::size_t first = text.find(attribute + ".timeSamples"), end = text.find('}', first);
  const std::size_t sample = text.rfind(": [", end);
  std::vector<float> numbers;
  for (std::size_t at = sample + 3; at < end;) {
    at = text.find_first_of("-.0123456789", at);
    if (at >= end) break;
    std::size_t read = 0;
    numbers.push_back(std::stof(text.substr(at, 32), &read));
    at += read;
  }
  return numbers;
}

Segments segments_in_usda(const std::string& text) {
  const std::vector<float> counts = last_sample(text, "curveVertexCounts"), numbers = last_sample(text, "points");
  Segments out;
  std::size_t at = 0;
  for (const float count : counts) {
    std::vector<Vec3f> line;
    for (std::size_t end = at + 3 * static_cast<std::size_t>(count); at < end; at += 3)
      line.push_back({numbers.at(at), numbers.at(at + 1), numbers.at(at + 2)});
    add_segments(line, out);
  }
  return out;
}

Segments segments_in_glb(const Glb& glb) {
  const json& primitive = glb.document["meshes"][0]["primitives"][0];
  std::vector<Vec3f> places = glb.read<Vec3f>(primitive["attributes"]["POSITION"]);
  const std::vector<Vec3f> moved = glb.read<Vec3f>(primitive["targets"].back()["POSITION"]);
  for (std::size_t i = 0; i < places.size(); ++i) places[i] += moved.at(i);
  const std::vector<unsigned> indices = glb.read<unsigned>(primitive["indices"]);
  Segments out;
  for (std::size_t i = 0; i < indices.size(); i += 2)
    add_segments({places.at(indices[i]), places.at(indices[i + 1])}, out);
  return out;
}

Segments segments_in_cache(const std::string& bytes, const Obj& mesh) {
  std::vector<Vec3f> places;
  for (std::size_t at = bytes.size() - 12 * mesh.vertices.size(); at < bytes.size(); at += 12)
    places.push_back(value_at<Vec3f>(bytes, at));
  return segments_of(mesh, places);
}

/// Expects segments between these points, each to the next, and no others.
void expect_links(const Segments& found, const std::vector<Vec3f>& points, const std::string& where) {
  EXPECT_EQ(found.size() + 1, points.size()) << where;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto is_link = [&](const std::array<Vec3f, 2>& s) {
      const auto joins = [&](const Vec3f& a, const Vec3f& b) {
        return length_squared(a - points[i]) < 1e-10f && length_squared(b - points[i + 1]) < 1e-10f;
      };
      return joins(s[0], s[1]) || joins(s[1], s[0]);
    };
    EXPECT_EQ(std::count_if(found.begin(), found.end(), is_link), 1) << where << ": link " << i;
  }
}

/// A rope of eight particles with a weight that is too heavy for any of its links. Its uppermost one breaks, and files
/// of every format then have the six others, and nothing from where it is held to what falls.
TEST(EveryFormat, HasThePiecesOfARopeThatBroke) {
  std::vector<Vec3f> places;
  for (int i = 0; i < 8; ++i) places.push_back({0, 2 - 0.2f * static_cast<float>(i), 0});
  Scene scene;
  Object rope = make_rope(places);
  rope.masses.assign(8, 0.02f);
  rope.masses.back() = 5;
  rope.pins = {{0, {}}};
  rope.constraints[0].stiffness = Stiffness::compliance(1e-5f);
  rope.constraints[0].break_force = 40;
  scene.add(std::move(rope));
  scene.settings.threads = 1;
  World world(scene);
  const Folder folder;
  std::vector<std::unique_ptr<FrameWriter>> writers;
  for (const char* suffix : {"obj", "ply", "pvd", "usda", "glb"})
    writers.push_back(make_frame_writer(folder / (std::string("run.") + suffix), scene, world));
  writers.push_back(make_frame_writer(folder / "cache.pc2", scene, world));
  constexpr int frames = 30;
  for (int frame = 0; frame < frames; ++frame) {
    for (const auto& writer : writers) writer->add(world);
    if (frame + 1 < frames) world.step(scene.frame_time);
  }
  for (const auto& writer : writers) writer->finish();

  std::vector<Vec3f> left = world.object(0).positions();
  ASSERT_GT(left[0].y - left[1].y, 0.5f) << "the uppermost link has broken";
  left.erase(left.begin());
  const Obj last = read_obj(folder / "run_0029.obj");
  expect_links(segments_of(last, last.vertices), left, "obj");
  expect_links(segments_in_ply(test::read(folder / "run_0029.ply")), left, "ply");
  const std::string name = output::identifiers(std::vector<std::string>{scene.objects[0].name}).front();
  expect_links(segments_in_vtp(test::read(folder / ("run/" + name + "_0029.vtp"))), left, "vtp");
  expect_links(segments_in_usda(test::read(folder / "run.usda")), left, "usda");
  expect_links(segments_in_glb(Glb(folder / "run.glb")), left, "glb");
  expect_links(segments_in_cache(test::read(folder / "cache.pc2"), read_obj(folder / "cache.obj")), left, "pc2");
}

}  // namespace
}  // namespace pliant
