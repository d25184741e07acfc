// A scene has one hash, whatever runs it: threads, lanes, sweep, compiler, build type. hashes.txt has the hashes. Every
// build compares itself with them, and so with all other builds.
//
// Change a hash only for a written reason: PLIANT_UPDATE_GOLDEN=1 rewrites hashes.txt, and the commit says why. The
// hashes of sweeps (sweeps_golden_test.cpp) are in the same file.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "golden/cases.h"
#include "golden/golden.h"
#include "support/ways_to_run.h"

namespace {

using namespace pliant::golden;
using pliant::testing_support::expect_hash;
using pliant::testing_support::ways_to_run;
using pliant::testing_support::WayToRun;

class Golden : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const Case found = make_case(GetParam());
    scene_ = found.scene;
    frames_ = found.frames;
    golden_ = updating() ? run(scene_, scene_.settings, frames_) : read_hashes()[GetParam()];
  }
  pliant::Settings settings_with(int threads, const std::string& isa) const {
    pliant::Settings settings = scene_.settings;
    settings.threads = threads;
    settings.isa = isa;
    return settings;
  }
  /// The hash of the scene, or the reason why there is none.
  std::string hash_with(int threads, const std::string& isa) const {
    return run(scene_, settings_with(threads, isa), frames_);
  }

  pliant::Scene scene_;
  std::string golden_;
  int frames_ = 0;
};

TEST_P(Golden, OnAnyThreadsAndInstructionSet) {
  std::vector<WayToRun> ways = ways_to_run();
  ways.pop_back();  // which AfterARestore takes
  expect_hash(
      golden_, [&](int threads, const std::string& isa) { return hash_with(threads, isa); }, ways);
}

/// `sequential` is the reference of `tiled` and has a name of its own; the reference of any other sweep is the code
/// path of that name.
TEST_P(Golden, InTheReferenceSweep) {
  pliant::Settings settings = pliant::chosen_settings(scene_);
  settings.threads = 1;
  settings.isa = "sequential";
  if (settings.sweep == pliant::Sweep::tiled) {
    settings.sweep = pliant::Sweep::sequential;
    settings.isa.clear();
  }
  EXPECT_EQ(run(scene_, settings, frames_), golden_);
}

TEST_P(Golden, AfterARestore) {
  const auto hash = [&](int threads, const std::string& isa) {
    pliant::World world(scene_, settings_with(threads, isa));
    for (int frame = 0; frame < frames_ / 2; ++frame) (void)world.step(scene_.frame_time);
    const pliant::State middle = world.state();
    for (int frame = 0; frame < 2; ++frame) (void)world.step(scene_.frame_time);
    world.restore(middle);
    for (int frame = frames_ / 2; frame < frames_; ++frame) (void)world.step(scene_.frame_time);
    return world.state_hash();
  };
  expect_hash(golden_, hash, {ways_to_run().back()});
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, testing::ValuesIn(scene_names()), [](const auto& scene) {
  std::string name = scene.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Golden);

TEST(GoldenFile, HoldsEverySceneAndSweepAndNoOther) {
  std::vector<std::string> names = scene_names();
  if (updating()) {
    std::ofstream file(hash_file);
    for (const std::string& name : names) {
      const Case found = make_case(name);
      file << name << " " << run(found.scene, found.scene.settings, found.frames) << "\n";
    }
    for (const auto& [name, hash] : sweep_hashes()) file << name << " " << hash << "\n";
  }
  std::vector<std::string> listed;
  for (const auto& [name, hash] : read_hashes()) {
    listed.push_back(name);
    EXPECT_EQ(hash.size(), 64u) << name;
  }
  for (const std::string& name : sweep_names()) names.push_back(name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(listed, names);
}

}  // namespace
