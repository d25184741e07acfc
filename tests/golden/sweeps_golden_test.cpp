// A sweep has one hash, whatever runs it: threads, lanes or plain floats, compiler, build type.
#include <gtest/gtest.h>

#include <algorithm>

#include "golden/cases.h"
#include "golden/golden.h"
#include "support/ways_to_run.h"

namespace pliant::golden {

namespace {

using validate::sweep_ways;
using validate::SweepWay;

std::string run_way(const SweepWay& way, int threads, const std::string& isa) {
  const Scene scene = scene_of(way);
  Settings settings = scene.settings;
  settings.threads = threads;
  settings.isa = isa;
  return run(scene, settings, sweep_frames);
}

class GoldenSweep : public testing::TestWithParam<SweepWay> {
 protected:
  void SetUp() override {
    const SweepWay& way = GetParam();
    golden_ = updating() ? run_way(way, 1, "sequential") : read_hashes()["sweep_" + way.name];
  }
  std::string golden_;
};

TEST_P(GoldenSweep, OnAnyThreadsAndInstructionSetAndInPlainCode) {
  const auto hash = [&](int threads, const std::string& isa) { return run_way(GetParam(), threads, isa); };
  std::vector<testing_support::WayToRun> ways = testing_support::ways_to_run();
  ways.push_back({1, "sequential"});
  testing_support::expect_hash(golden_, hash, ways);
}

TEST_P(GoldenSweep, MeetsContactsAndMoves) {
  const Scene scene = scene_of(GetParam());
  World world(scene);
  std::int64_t contacts = 0;
  for (int frame = 0; frame < sweep_frames; ++frame) contacts += world.step(scene.frame_time).contacts;
  EXPECT_GT(contacts, 0);
  EXPECT_GT(world.measure().kinetic_energy(), 0);
}

INSTANTIATE_TEST_SUITE_P(Ways, GoldenSweep, testing::ValuesIn(sweep_ways()),
                         [](const auto& way) { return way.param.name; });

TEST(GoldenSweeps, AreAllThereAre) {
  for (const NamedSweep& sweep : sweeps()) {
    const auto is_it = [&](const SweepWay& way) { return way.sweep == sweep.sweep; };
    EXPECT_TRUE(std::any_of(sweep_ways().begin(), sweep_ways().end(), is_it)) << sweep.name << " is not in the table";
  }
}

TEST(GoldenSweeps, DifferWhereTheyShould) {
  std::map<std::string, std::string> hashes = read_hashes();
  EXPECT_EQ(hashes["sweep_tiled"], hashes["sweep_sequential"]);
  std::vector<std::string> others;
  for (const SweepWay& way : sweep_ways())
    if (way.sweep != Sweep::sequential) others.push_back(hashes["sweep_" + way.name]);
  std::sort(others.begin(), others.end());
  EXPECT_EQ(std::adjacent_find(others.begin(), others.end()), others.end()) << "two ways are one";
}

}  // namespace

std::map<std::string, std::string> sweep_hashes() {
  std::map<std::string, std::string> hashes;
  for (const SweepWay& way : sweep_ways()) hashes["sweep_" + way.name] = run_way(way, 1, "sequential");
  return hashes;
}

}  // namespace pliant::golden
