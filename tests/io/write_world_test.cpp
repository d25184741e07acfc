// Tests the public FrameWriter with a World.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "glb_support.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "write_support.h"

namespace pliant {
namespace {

/// A small cloth and a rope that fall.
Scene falling() {
  Scene scene;
  scene.add_cloth(grid_mesh(4, 3, 1, 1));
  scene.add(make_rope({{0, 1, 0}, {0.1f, 1, 0}, {0.2f, 1, 0}}));
  scene.settings.substeps = 2;
  scene.settings.threads = 1;
  return scene;
}

TEST(FrameWriter, WritesWhatTheWorldHolds) {
  const test::Folder folder;
  const Scene scene = falling();
  World world(scene);
  const auto writer = make_frame_writer(folder / "run.pc2", scene, world);
  std::vector<Vec3f> expected;
  for (int frame = 0; frame < 3; ++frame) {
    if (frame > 0) {
      ASSERT_TRUE(world.step(scene.frame_time).ok());
    }
    writer->add(world);
    for (int object = 0; object < 2; ++object)
      for (const Vec3f& position : world.object(object).positions()) expected.push_back(position);
  }
  writer->finish();
  const std::string bytes = test::read(folder / "run.pc2");
  ASSERT_EQ(bytes.size(), 32 + expected.size() * 12);
  EXPECT_EQ(test::value_at<int>(bytes, 16), 15);
  EXPECT_EQ(test::value_at<int>(bytes, 28), 3);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(test::value_at<Vec3f>(bytes, 32 + i * 12), expected[i]);
  EXPECT_LT(expected.back().y, 1) << "nothing fell";
}

TEST(FrameWriter, ReadsBackAsTheMeshOfTheWorld) {
  const test::Folder folder;
  Scene scene = falling();
  scene.objects.pop_back();
  World world(scene);
  for (const std::string suffix : {"obj", "ply"}) {
    const auto writer = make_frame_writer(folder / ("run." + suffix), scene, world);
    writer->add(world);
    writer->finish();
    const TriangleMesh mesh = read_mesh(folder / ("run_0000." + suffix));
    EXPECT_EQ(mesh.positions, world.object(0).mesh().positions) << suffix;
    EXPECT_EQ(mesh.triangles, world.object(0).mesh().triangles) << suffix;
  }
}

TEST(FrameWriter, RefusesAnotherScenesWorldAndUnknownSuffixes) {
  const test::Folder folder;
  const Scene scene = falling();
  const World world(scene);
  EXPECT_THROW(make_frame_writer(folder / "run.txt", scene, world), Error);
  EXPECT_THROW(make_frame_writer(folder / "run.obj", Scene{}, world), Error);
  EXPECT_TRUE(folder.names().empty());
}

TEST(FrameWriter, RefusesASceneThatTheWorldWasNotMadeFrom) {
  const test::Folder folder;
  const Scene scene = falling();
  const World world(scene);
  const auto refused = [&](const auto& spoil) {
    Scene other = scene;
    spoil(other);
    EXPECT_THROW(make_frame_writer(folder / "run.glb", other, world), Error);
  };
  refused([](Scene& s) { s.objects[0].triangles[2][1] = 1000000; });
  refused([](Scene& s) { s.objects[0].triangles[2][1] = -1; });
  refused([](Scene& s) { s.objects[0].positions.pop_back(); });
  refused([](Scene& s) { s.objects[1].constraints[0].particles[1] = 3; });
  refused([](Scene& s) { s.objects[1].constraints[0].particles[1] = -2000000000; });
  EXPECT_TRUE(folder.names().empty());
}

/// A rope of three links, held at its first two particles: the weight of the third breaks the second link in the first
/// frame. A box falls beside it.
Scene breaking(float break_force) {
  Scene scene;
  Object rope = make_rope({{0, 3, 0}, {0, 2, 0}, {0, 1, 0}, {0, 0.5f, 0}});
  rope.masses = {1, 1, 2, 0.1f};
  rope.pins = {{0}, {1}};
  rope.constraints[0].stiffness = Stiffness::compliance(1e-5f);
  rope.constraints[0].break_force = break_force;
  scene.add(std::move(rope));
  scene.add(make_body({{Box{{0.1f, 0.1f, 0.1f}}}}));
  scene.settings.threads = 1;
  return scene;
}

/// Writes the start and the first frame of the rope.
void write_breaking(const std::string& path, float break_force = 10) {
  const Scene scene = breaking(break_force);
  World world(scene);
  const auto writer = make_frame_writer(path, scene, world);
  writer->add(world);
  const Report report = world.step(scene.frame_time);
  ASSERT_EQ(report.torn.size(), break_force < 20 ? 1U : 0U);
  writer->add(world);
  writer->finish();
}

/// The lines of a text that begin so.
std::vector<std::string> lines_with(const std::string& text, const std::string& start) {
  std::vector<std::string> found;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (line.rfind(start, 0) == 0) found.push_back(line);
  return found;
}

TEST(FrameWriter, WritesThePiecesOfARopeThatBroke) {
  const test::Folder folder;
  for (const char* suffix : {"obj", "ply", "pvd", "usda"}) write_breaking(folder / (std::string("run.") + suffix));
  EXPECT_EQ(lines_with(test::read(folder / "run_0000.obj"), "l "), (std::vector<std::string>{"l 1 2 3 4"}));
  EXPECT_EQ(lines_with(test::read(folder / "run_0001.obj"), "l "), (std::vector<std::string>{"l 1 2", "l 3 4"}));
  EXPECT_EQ(test::occurrences(test::read(folder / "run_0000.ply"), "element edge 3\n"), 1);
  EXPECT_EQ(test::occurrences(test::read(folder / "run_0001.ply"), "element edge 2\n"), 1);
  EXPECT_EQ(test::occurrences(test::read(folder / "run/rope_0000.vtp"), "NumberOfLines=\"1\""), 1);
  EXPECT_EQ(test::occurrences(test::read(folder / "run/rope_0001.vtp"), "NumberOfLines=\"2\""), 1);
  const std::string usd = test::read(folder / "run.usda");
  EXPECT_EQ(
      test::occurrences(usd, "int[] curveVertexCounts.timeSamples = {\n            0: [4],\n            1: [2, 2],\n"),
      1);
}

/// The lines of a .glb do not change: the two ends of the link that broke come together.
TEST(FrameWriter, HidesLinksThatBreakWhereLinesCannotChange) {
  const test::Folder folder;
  write_breaking(folder / "run.glb");
  const test::Glb glb(folder / "run.glb");
  const auto& primitive = glb.document["meshes"][glb.node("rope")["mesh"].get<std::size_t>()]["primitives"][0];
  EXPECT_EQ(glb.read<unsigned>(primitive["indices"]), (std::vector<unsigned>{0, 1, 2, 3, 4, 5}));
  const auto start = glb.read<Vec3f>(primitive["attributes"]["POSITION"]);
  const auto moved = glb.read<Vec3f>(primitive["targets"][0]["POSITION"]);
  ASSERT_EQ(start.size(), 6U);
  EXPECT_EQ(start[2].y - start[3].y, 1);
  EXPECT_EQ(start[2] + moved[2], start[3] + moved[3]);
  EXPECT_NEAR(start[4].y + moved[4].y - start[5].y - moved[5].y, 0.5f, 0.01f);
  write_breaking(folder / "run.pc2");
  const std::string cache = test::read(folder / "run.pc2");
  const int points = test::value_at<int>(cache, 16);
  EXPECT_EQ(test::value_at<Vec3f>(cache, 32 + 12 * (static_cast<std::size_t>(points) + 2)),
            test::value_at<Vec3f>(cache, 32 + 12 * (static_cast<std::size_t>(points) + 3)));
}

TEST(FrameWriter, WritesARopeThatTears) {
  const test::Folder folder;
  Scene scene = breaking(0);
  scene.objects[0].tearing = Tearing{1.0001f};
  scene.objects[0].constraints[0].stiffness = Stiffness::compliance(1e-3f);
  World world(scene);
  const auto writer = make_frame_writer(folder / "run.obj", scene, world);
  writer->add(world);
  int torn = 0;
  for (int i = 0; i < 20 && torn == 0; ++i) torn += static_cast<int>(world.step(scene.frame_time).torn.size());
  ASSERT_EQ(torn, 1);
  writer->add(world);
  EXPECT_EQ(lines_with(test::read(writer->written().back().path), "l "), (std::vector<std::string>{"l 1 2", "l 3 4"}));
}

TEST(FrameWriter, APointCacheReplacesNoMeshButItsOwn) {
  const test::Folder folder;
  const Scene scene = falling();
  const World world(scene);
  const auto write = [&] {
    const auto writer = make_frame_writer(folder / "run.pc2", scene, world);
    writer->add(world);
    writer->finish();
  };
  write();
  EXPECT_NO_THROW(write()) << "its own";
  write_mesh(folder / "run.obj", grid_mesh(2, 2, 1, 1));
  const std::string before = test::read(folder / "run.obj");
  EXPECT_THROW(write(), Error);
  EXPECT_EQ(test::read(folder / "run.obj"), before);
}

}  // namespace
}  // namespace pliant
