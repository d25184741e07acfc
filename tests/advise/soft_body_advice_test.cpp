// Tests advice for soft bodies: which settings are tried, and which of them do not suffice.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "advise/advise_support.h"
#include "matter/advice_settings.h"
#include "pliant/soft_body.h"
#include "support/pulled_cube.h"
#include "world/advice.h"

namespace pliant {
namespace {

using namespace testing_support;

Scene pulled_foam(float way) { return pulled_cube(way, elastic_solid("foam")); }

bool stays_whole(const Scene& scene, const Settings& settings) {
  World world(scene, settings);
  for (int frame = 0; frame < scene.frames; ++frame)
    if (!world.step(scene.frame_time).ok()) return false;
  return world.measure().tetrahedra().inverted == 0;
}

/// Pulled by 4 m, the foam burst by default (tests/soft_bodies/burst_test.cpp).
TEST(Advise, HasNothingToMendWhereASoftBodyStaysWhole) {
  const Scene scene = pulled_foam(4);
  EXPECT_TRUE(stays_whole(scene, chosen_settings(scene)));
  const Advice advice = advise(scene, unhurried);
  EXPECT_EQ(advice.words, "");
  const int by_default = chosen_settings(scene).substeps;
  for (const Trial& trial : advice.others) {
    EXPECT_GE(trial.settings.substeps, by_default) << "the body would be softer";
    EXPECT_EQ(trial.settings.sweep, Sweep::tiled) << "it has no lengths";
    EXPECT_FALSE(trial.settings.sweep_options.tethers);
    EXPECT_EQ(is_good(trial), stays_whole(scene, trial.settings)) << trial.settings.substeps;
  }
}

/// A sheet that is too long with one substep, and a box that its pins turn inside out with any settings.
TEST(Advise, NamesNothingThatLeavesTetrahedraInsideOut) {
  Scene scene = hanging_sheet(8, Stiffness::rigid(), 1);
  scene.frames = 10;
  const Advice of_the_sheet = advise(scene, unhurried);
  ASSERT_TRUE(of_the_sheet.best == 0 && is_good(of_the_sheet.others[0])) << "or this shows nothing";
  Object box = make_soft_body(box_tetrahedra({0.1f, 0.1f, 0.1f}, {1, 1, 1}));
  for (int i = 0; i < static_cast<int>(box.positions.size()); ++i) {
    const bool moves = box.positions[static_cast<std::size_t>(i)].x > 0;
    box.pins.push_back({i, moves ? straight({-0.3f, 0, 0}, 0.1f) : Motion{}});
  }
  scene.add(box);
  const Advice advice = advise(scene, unhurried);
  ASSERT_FALSE(advice.others.empty());
  EXPECT_EQ(advice.best, -1) << advice.what_to_do;
  for (const Trial& trial : advice.others) EXPECT_FALSE(is_good(trial));
}

TEST(Words, NameNoEdgesWhereThereAreNone) {
  Advice advice;
  advice.own.worst.largest = std::numeric_limits<double>::infinity();
  Trial refused = advice.own;
  refused.complete = true;
  advice.others = {refused};
  const std::string words = "of 1 other setting tried none keeps all values finite and no tetrahedron inside out: ";
  EXPECT_EQ(remedy(advice, {}).rfind(words, 0), 0U) << remedy(advice, {});
}

TEST(BetterSweeps, AreNoneForSoftBodies) {
  Scene scene = pulled_foam(0);
  scene.settings.sweep = Sweep::tiled;
  EXPECT_TRUE(better_sweeps(scene).empty());
  EXPECT_FALSE(may_tether(scene));
  scene.add(chain(40, 0.02f));
  scene.pin(1, {0});
  EXPECT_TRUE(better_sweeps(scene).empty()) << "the soft body would have them too";
  EXPECT_FALSE(may_tether(scene)) << "tethers would hold the soft body back";
}

}  // namespace
}  // namespace pliant
