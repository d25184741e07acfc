// Tests the time limit of advice, and being told to stop.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "advise/advise_support.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(Advise, HoldsForTheFramesThatItHadTimeForAndSaysSo) {
  int frames = 0;  // the scene's own settings get time for five frames; other trials get all they want
  const Scene scene = hanging_sheet(12, Stiffness::rigid(), 2);
  const Advice advice = advise(scene, {1e6, 120, [&] { return ++frames == 5; }});
  EXPECT_EQ(advice.frames, 30);
  EXPECT_EQ(advice.own.frames, 5);
  ASSERT_GE(advice.best, 0);
  EXPECT_EQ(advice.others[advice.best].frames, 5);
  EXPECT_EQ(advice.what_to_do.rfind("only the first 5 of 30 frames were run", 0), 0U) << advice.what_to_do;
  EXPECT_NE(advice.what_to_do.find(" to try it, remove "), std::string::npos) << advice.what_to_do;
}

/// Time is kept for other trials only where the first one found something.
TEST(Advise, UsesAllOfItsTimeForASceneThatIsFine) {
  Scene scene = hanging_sheet(8, Stiffness::rigid(), 150);
  scene.frames = 5;
  int frames = 0;
  const Advice advice = advise(scene, {4, 120, [&] {
                                         if (++frames == 1)
                                           std::this_thread::sleep_for(std::chrono::milliseconds(1300));
                                         return false;
                                       }});
  EXPECT_EQ(advice.own.frames, 5);
  EXPECT_FALSE(advice.cut_short);
}

TEST(Advise, StopsWhenItsTimeIsOutAndSaysSo) {
  const Advice none = advise(hanging_sheet(12, Stiffness::rigid(), 1), {0, 120, {}});
  EXPECT_TRUE(none.cut_short);
  EXPECT_EQ(none.own.frames, 1);
  EXPECT_TRUE(none.others.empty());
  Scene scene = hanging_sheet(40, Stiffness::rigid(), 1);
  scene.gravity = {0, -1000, 0};  // bad in its first frame
  const Advice cut = advise(scene, {0, 120, {}});
  EXPECT_TRUE(cut.cut_short);
  EXPECT_NE(cut.words, "");
  EXPECT_NE(cut.what_to_do.find("within the time limit"), std::string::npos) << cut.what_to_do;
}

TEST(Advise, StopsWhenItIsTold) {
  int frames = 0;
  const Advice told = advise(hanging_sheet(12, Stiffness::rigid(), 2), {1e6, 120, [&] { return ++frames >= 5; }});
  EXPECT_TRUE(told.cut_short);
  EXPECT_EQ(told.own.frames, 5);
  EXPECT_TRUE(told.others.empty());
}

}  // namespace
}  // namespace pliant
