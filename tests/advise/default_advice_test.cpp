// Tests advice that concerns the default: return to it, bounds of its substeps, an object's own sweep.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "advise/advise_support.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(Advise, NamesTheDefaultIfItHelps) {
  const Scene scene = hanging_sheet(12, Stiffness::rigid(), 2);
  const Advice advice = advise(scene, unhurried);
  EXPECT_FALSE(is_good(advice.own));
  ASSERT_EQ(advice.others.size(), 1U);
  ASSERT_EQ(advice.best, 0);
  const Trial& best = advice.others[0];
  EXPECT_TRUE(is_default(best));
  EXPECT_TRUE(is_good(best));
  EXPECT_LE(largest_stretch(scene, best.settings), 1 + tolerated_overstretch);
  EXPECT_EQ(advice.what_to_do.rfind("the default (", 0), 0U) << advice.what_to_do;
  EXPECT_NE(advice.what_to_do.find("keeps all edges within 10 % and 99 in 100 within 2 %"), std::string::npos)
      << advice.what_to_do;
  EXPECT_NE(advice.what_to_do.find("; remove \"sweep\" and \"substeps\" from the scene's \"settings\""),
            std::string::npos)
      << advice.what_to_do;
}

TEST(Advise, TriesTheDefaultFirstWhereTheSceneDepartsFromIt) {
  Scene scene = hanging_sheet(8, Stiffness::rigid(), 1);
  scene.frames = 10;
  EXPECT_TRUE(is_default(advise(scene, unhurried).others.at(0)));
  const Scene poor = poor_by_default(hanging_sheet(32, Stiffness::rigid(), 0));
  for (const Trial& trial : advise(poor, unhurried).others) EXPECT_FALSE(is_default(trial)) << "that is its own";
}

/// Cloth that stretches because its substeps are bounded: the advice is to remove the bound that is there.
TEST(Advise, RemovesTheBoundsOfSubsteps) {
  Scene scene = hanging_sheet(24, Stiffness::rigid(), 0);
  scene.settings = {};
  scene.settings.sweep = Sweep::chains;
  scene.settings.least_substeps = scene.settings.most_substeps = 1;
  const Advice advice = advise(scene, unhurried);
  ASSERT_FALSE(is_good(advice.own)) << "or this shows nothing";
  ASSERT_EQ(advice.best, 0);
  EXPECT_EQ(advice.others[0].settings.most_substeps, 0);
  EXPECT_NE(
      advice.what_to_do.find(R"(; remove "sweep", "least_substeps" and "most_substeps" from the scene's "settings")"),
      std::string::npos)
      << advice.what_to_do;
}

/// A sheet so heavy that no number of substeps keeps it short. Its pins move apart, so it has no tethers, and its
/// substeps follow the State.
Scene overloaded_sheet() {
  Scene scene = hanging_sheet(24, Stiffness::rigid(), 0);
  scene.settings = {};
  scene.objects[0].pins[1].motion = straight({1e-3f, 0, 0}, 1);  // pins that move apart: no tethers
  scene.objects[0].self_collision = true;
  scene.gravity = {0, -3000, 0};
  scene.frames = 2;
  return scene;
}

/// Where the default follows the State and is not good, a larger lower bound is tried.
TEST(Advise, TriesLargerBoundsOfSubsteps) {
  const Advice advice = advise(overloaded_sheet(), unhurried);
  ASSERT_FALSE(is_good(advice.own)) << "or this shows nothing";
  std::vector<int> least;
  for (const Trial& trial : advice.others)
    if (trial.settings.substeps == 0) least.push_back(trial.settings.least_substeps);
  ASSERT_GE(least.size(), 2U);
  EXPECT_EQ(least[0], 24);
  EXPECT_EQ(least[1], 48);
}

/// Twice a bound may be no multiple of four, and bounds with none between them are refused.
TEST(Advise, TriesBoundsOfSubstepsThatAreAccepted) {
  Scene scene = overloaded_sheet();
  scene.settings.least_substeps = 15;
  scene.settings.most_substeps = 20;
  const Advice advice = advise(scene, unhurried);
  ASSERT_FALSE(is_good(advice.own)) << "or this shows nothing";
  const auto has_larger = [](const Trial& trial) {
    return trial.settings.least_substeps == 32 && trial.settings.most_substeps == 32;
  };
  EXPECT_TRUE(std::any_of(advice.others.begin(), advice.others.end(), has_larger));
}

/// Other settings are tried without an object's own sweep, which would replace them, and the advice is to remove it.
TEST(Advise, RemovesTheSweepOfAnObject) {
  Scene scene = hanging_sheet(24, Stiffness::rigid(), 0);
  scene.settings = {};
  scene.objects[0].sweep = Sweep::jacobi;
  const Advice advice = advise(scene, unhurried);
  ASSERT_FALSE(is_good(advice.own)) << "or this shows nothing";
  ASSERT_EQ(advice.best, 0);
  EXPECT_TRUE(is_good(advice.others[0]));
  EXPECT_NE(advice.what_to_do.find("; remove \"sweep\" from object '" + scene.objects[0].name + "'"), std::string::npos)
      << advice.what_to_do;
  scene.settings.sweep = Sweep::chains;
  scene.settings.substeps = 2;
  EXPECT_NE(advise(scene, unhurried).what_to_do.find(" from the scene's \"settings\" and remove \"sweep\" from object"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
