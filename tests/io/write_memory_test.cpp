// Tests frame writers whose files stay in memory: every format gives the bytes that it writes to disk.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "write_support.h"

namespace pliant {
namespace {

constexpr const char* all_suffixes[] = {"obj", "ply", "glb", "usda", "pc2", "pvd"};

/// A cloth, a rope that can break, and a box.
Scene sheet_rope_and_box() {
  Scene scene;
  scene.add_cloth(grid_mesh(4, 3, 1, 1));
  Object rope = make_rope({{0, 1, 0}, {0.1f, 1, 0}, {0.2f, 1, 0}});
  rope.constraints[0].stiffness = Stiffness::compliance(1e-5f);
  rope.constraints[0].break_force = 10;
  scene.add(std::move(rope));
  scene.add(make_body({{Box{{0.1f, 0.1f, 0.1f}}}}));
  scene.settings.substeps = 2;
  scene.settings.threads = 1;
  return scene;
}

/// Adds the start and two frames, and finishes. Returns the writer.
std::unique_ptr<FrameWriter> write_frames(const std::string& path, const FrameWriterOptions& options = {}) {
  const Scene scene = sheet_rope_and_box();
  World world(scene);
  auto writer = make_frame_writer(path, scene, world, options);
  for (int frame = 0; frame < 3; ++frame) {
    if (frame > 0) world.step(scene.frame_time);
    writer->add(world);
  }
  writer->finish();
  return writer;
}

/// A sink that counts within itself, as a lambda with a state does: a copy for each file would begin anew.
struct CountingSink {
  std::map<std::string, std::string>* files;
  int* most;
  int count = 0;
  void operator()(const std::string& path, const std::vector<std::byte>& bytes) {
    (*files)[path] = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    *most = ++count;
  }
};

TEST(FrameWriterInMemory, GivesTheBytesOfTheFiles) {
  for (const std::string suffix : all_suffixes) {
    const test::Folder folder, empty;
    const auto on_disk = write_frames(folder / ("run." + suffix))->written();
    std::map<std::string, std::string> files;
    int calls = 0;
    const auto in_memory = write_frames(empty / ("run." + suffix), {.sink = CountingSink{&files, &calls}})->written();
    ASSERT_EQ(in_memory.size(), on_disk.size()) << suffix;
    EXPECT_EQ(files.size(), on_disk.size()) << suffix;
    EXPECT_EQ(calls, static_cast<int>(on_disk.size())) << suffix;
    for (std::size_t i = 0; i < on_disk.size(); ++i) {
      const std::string name = on_disk[i].path.substr(folder.path().size());
      EXPECT_EQ(in_memory[i].path, empty.path() + name);
      EXPECT_EQ(in_memory[i].bytes, on_disk[i].bytes) << name;
      EXPECT_TRUE(files[in_memory[i].path] == test::read(on_disk[i].path)) << name << " has other bytes in memory";
    }
    EXPECT_TRUE(empty.names().empty()) << suffix << " left something on disk";
  }
}

TEST(FrameWriterInMemory, NeedsNoFolder) {
  for (const std::string suffix : all_suffixes) {
    int files = 0;
    write_frames("/missing/run." + suffix,
                 {.sink = [&](const std::string&, const std::vector<std::byte>&) { ++files; }});
    EXPECT_GE(files, 1) << suffix;
  }
}

TEST(FrameWriterInMemory, PassesFilesOfFramesWhenTheyAreComplete) {
  const Scene scene = sheet_rope_and_box();
  World world(scene);
  std::vector<std::string> names;
  const FrameWriterOptions options{
      .sink = [&](const std::string& path, const std::vector<std::byte>&) { names.push_back(path); }};
  const auto objs = make_frame_writer("run.obj", scene, world, options);
  objs->add(world);
  EXPECT_EQ(names, std::vector<std::string>{"run_0000.obj"});
  const auto glb = make_frame_writer("run.glb", scene, world, options);
  glb->add(world);
  EXPECT_EQ(names.size(), 1u) << "a .glb is complete at finish()";
  glb->finish();
  EXPECT_EQ(names.back(), "run.glb");
}

TEST(FrameWriterInMemory, RefusesOtherFormatsAndPassesExceptionsOn) {
  const FrameWriterOptions throwing{.sink = [](const std::string& path, const std::vector<std::byte>&) {
    throw std::runtime_error("no room for " + path);
  }};
  try {
    write_frames("run.ply", throwing);
    FAIL() << "the exception of the sink is lost";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), "no room for run_0000.ply");
  }
  try {
    write_frames("run.txt", throwing);
    FAIL() << "a .txt was written";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'.txt' is not a geometry format"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace pliant
