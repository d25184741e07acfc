// Saves every scene in scenes/ at random frames, and continues in a new World from the file alone: the bits must be
// those of a run that never stopped. Any dependence of a step on more than its State would show here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <set>

#include "pliant/io.h"
#include "pliant/save.h"
#include "support/paths.h"
#include "support/sanitized.h"
#include "write_support.h"

namespace pliant {
namespace {

std::vector<std::string> all_scenes() {
  std::vector<std::string> names;
  const std::filesystem::path folder = test::in_tree("scenes");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".json") names.push_back(std::filesystem::relative(entry.path(), folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

class Resume : public testing::TestWithParam<std::string> {};

/// With PLIANT_RESUME_FRAMES=all a scene runs to its end and is saved ten times.
TEST_P(Resume, EqualsTheRunThatNeverStopped) {
  const Scene scene = read_scene(test::in_tree("scenes/" + GetParam()));
  const bool all = std::getenv("PLIANT_RESUME_FRAMES") != nullptr;
  const int frames = all ? scene.frames : testing_support::fewer_if_sanitized(6, 3), saves = all ? 10 : 2;
  std::mt19937 random(static_cast<unsigned>(GetParam().size()) * 31 + GetParam()[0]);
  std::set<std::int64_t> saved_at;
  for (int i = 0; i < saves; ++i) saved_at.insert(random() % frames);

  const test::Folder folder;
  std::vector<std::string> hashes;
  World world(scene);
  for (int frame = 0; frame <= frames; ++frame) {
    hashes.push_back(world.state_hash());
    if (saved_at.count(frame) > 0) save(folder / std::to_string(frame), world.state(), scene);
    if (frame + 1 == frames) save(folder / "world", world, scene);
    world.step(scene.frame_time);
  }
  for (const std::int64_t start : saved_at) {
    World other(scene);
    other.restore(load_state(folder / std::to_string(start), scene));
    const std::int64_t last = all ? std::min<std::int64_t>(frames, start + 20) : frames;
    for (std::int64_t frame = start; frame < last; ++frame) {
      ASSERT_EQ(other.state_hash(), hashes[frame]) << "saved at " << start;
      other.step(scene.frame_time);
    }
    EXPECT_EQ(other.state_hash(), hashes[last]) << "saved at " << start;
  }
  LoadedWorld loaded = load_world(folder / "world");
  loaded.world.step(loaded.scene.frame_time);
  EXPECT_EQ(loaded.world.state_hash(), hashes[frames]) << "from the file of a World";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Resume, testing::ValuesIn(all_scenes()), [](const auto& scene) {
  std::string name = scene.param.substr(0, scene.param.size() - 5);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

}  // namespace
}  // namespace pliant
