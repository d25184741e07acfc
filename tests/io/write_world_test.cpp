// Tests the public FrameWriter with a World.
#include <gtest/gtest.h>

#include <sstream>

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
