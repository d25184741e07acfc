// Tests advice: settings that were really tried, and which of them is named.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "advise/advise_support.h"
#include "world/advice.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(Advise, NamesASettingThatReallyHelps) {
  const Scene scene = poor_by_default(hanging_sheet(32, Stiffness::rigid(), 0));
  const Advice advice = advise(scene, unhurried);
  EXPECT_FALSE(advice.cut_short);
  EXPECT_FALSE(is_good(advice.own));
  EXPECT_NEAR(1 + advice.own.worst.largest, largest_stretch(scene, scene.settings), 1e-6);
  ASSERT_GE(advice.best, 0);
  const Trial& best = advice.others[advice.best];
  ASSERT_TRUE(is_good(best));
  EXPECT_LE(largest_stretch(scene, best.settings), 1 + tolerated_overstretch);
  EXPECT_EQ(best.frames, scene.frames);
  for (const Trial& trial : advice.others) {
    EXPECT_TRUE(!is_good(trial) || trial.milliseconds >= best.milliseconds);
  }
  EXPECT_EQ(advice.words.rfind("in frame ", 0), 0U) << advice.words;
  EXPECT_NE(advice.words.find("object 'sheet': stretched "), std::string::npos) << advice.words;
  EXPECT_NE(advice.words.find("its pins"), std::string::npos) << advice.words;
  EXPECT_NE(advice.what_to_do.find(std::to_string(best.settings.substeps) + " substep"), std::string::npos);
  EXPECT_NE(advice.what_to_do.find("99 in 100 within 2 %"), std::string::npos) << advice.what_to_do;
  for (const char* sweep : {"chains", "multigrid", "tiled"}) {
    const auto is_of_it = [&](const Trial& trial) { return sweep_name(trial.settings.sweep) == sweep; };
    EXPECT_TRUE(std::any_of(advice.others.begin(), advice.others.end(), is_of_it)) << sweep << " was not tried";
  }
}

/// Multigrid gains energy from contact between surfaces, so it is no advice there.
TEST(Advise, TriesChainsAndNoMultigridWhereWhatMovesTouches) {
  Scene scene = poor_by_default(hanging_sheet(32, Stiffness::rigid(), 0));
  scene.objects[0].self_collision = true;
  scene.frames = 12;
  const Advice advice = advise(scene, unhurried);
  const auto tries = [&](Sweep sweep) {
    return std::any_of(advice.others.begin(), advice.others.end(),
                       [&](const Trial& trial) { return trial.settings.sweep == sweep; });
  };
  EXPECT_TRUE(tries(Sweep::chains));
  EXPECT_FALSE(tries(Sweep::multigrid));
}

TEST(Advise, FindsTheLeastOfWhatHelps) {
  // Chains hold a rope with 20 substeps and with far fewer, so fewer must be tried too, and not more than needed.
  Scene scene;
  scene.add(chain(40, 0.02f));
  scene.pin(0, {0});
  scene = poor_by_default(scene);
  scene.frames = 20;
  const Advice advice = advise(scene, unhurried);
  ASSERT_GE(advice.best, 0);
  int least = 20;
  for (const Trial& trial : advice.others)
    if (trial.settings.sweep == Sweep::chains && is_good(trial)) least = std::min(least, trial.settings.substeps);
  EXPECT_LT(least, 20);
  for (const Trial& trial : advice.others)
    EXPECT_TRUE(!is_good(trial) || trial.milliseconds >= advice.others[advice.best].milliseconds)
        << "the cheapest is named";
  Settings fewer = chosen_settings(scene);
  fewer.sweep = Sweep::chains;
  fewer.sweep_options.tethers = true;
  fewer.substeps = std::max(1, least / 2);
  World world(scene, fewer);
  Report last;
  for (int frame = 0; frame < scene.frames; ++frame) last = world.step(scene.frame_time);
  EXPECT_FALSE(is_tolerable(last.worst_overstretch.overstretch)) << least << " substeps were good";
}

/// Multigrid keeps lengths with a single substep, which damps all motion.
TEST(Advise, TriesNoFewerThanFourSubstepsOfMultigrid) {
  for (const int substeps : {0, 1}) {
    Scene scene = poor_by_default(hanging_sheet(32, Stiffness::rigid(), 0));
    scene.settings.substeps = substeps;
    scene.frames = 10;
    int least = 1000;
    for (const Trial& trial : advise(scene, unhurried).others)
      if (trial.settings.sweep == Sweep::multigrid) least = std::min(least, trial.settings.substeps);
    EXPECT_GE(least, 4);
    EXPECT_LT(least, 10) << "fewer were tried, or this shows nothing";
  }
}

TEST(Advise, SaysNothingWhereNothingIsTheMatter) {
  const Advice fine = advise(hanging_sheet(8, Stiffness::rigid(), 150), unhurried);
  EXPECT_TRUE(is_good(fine.own));
  EXPECT_EQ(fine.words + fine.what_to_do, "");
  EXPECT_TRUE(fine.others.empty());
  Scene nothing;
  nothing.frames = 100;
  EXPECT_EQ(advise(nothing, unhurried).words, "");
  EXPECT_EQ(advise(nothing, unhurried).own.frames, 1) << "no length to look at";
}

TEST(Advise, LetsRubberStretch) {
  const Scene scene = hanging_sheet(8, Stiffness::compliance(0.05f), 40);
  EXPECT_GT(largest_stretch(scene, scene.settings), 1.1) << "or this shows nothing";
  EXPECT_EQ(advise(scene, unhurried).words, "");
  for (const Trial& trial : advise(hanging_sheet(8, Stiffness::compliance(1e-4f), 1), unhurried).others)
    EXPECT_FALSE(trial.settings.sweep_options.tethers) << "they would hold back what is meant to stretch";
}

TEST(Advise, KnowsWhenNothingHelps) {
  Scene scene;
  constexpr int links = 24;
  Object ring = chain(links, 0.1f);  // its 2.4 m are around a ball of 3.1 m
  ConstraintGroup& group = ring.constraints[0];
  group.particles.insert(group.particles.end(), {links - 1, 0});
  group.rest.assign(links, 0.1f);
  for (int i = 0; i < links; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / links;
    ring.positions[static_cast<std::size_t>(i)] = {0.4f * std::cos(angle), 0, 0.4f * std::sin(angle)};
  }
  scene.add(ring);
  Collider ball;
  ball.shape = Sphere{0.5f};
  scene.add(ball);
  scene.gravity = {};
  scene.settings = settings_of(4);
  scene.frames = 20;
  const Advice advice = advise(scene, unhurried);
  EXPECT_EQ(advice.best, -1);
  EXPECT_GT(advice.others.size(), 3U);
  const std::string tried =
      "of " + std::to_string(advice.others.size()) + " other settings tried none is clearly better";
  EXPECT_EQ(advice.what_to_do.rfind(tried, 0), 0U) << advice.what_to_do;
  EXPECT_EQ(advice.what_to_do.find("settings\":"), std::string::npos) << "nothing is advised: " << advice.what_to_do;
}

TEST(Advise, NamesTheBestOfWhatIsNotGoodAndSaysSo) {
  Scene scene;
  scene.add(chain(40, 0.02f));
  scene.pin(0, {0});
  Object taut = chain(3, 0.5f);
  taut.name = "taut";
  for (Vec3f& p : taut.positions) p.z = 1;
  scene.add(taut);
  scene.pin(1, {0});
  scene.pin(1, {2}, straight({0.2f, 0, 0}, 0.1f));  // no setting can reduce this below 120 %
  scene.settings = settings_of(1);
  scene.frames = 20;
  const Advice advice = advise(scene, unhurried);
  ASSERT_GE(advice.best, 0);
  const Trial& best = advice.others[advice.best];
  EXPECT_GT(advice.own.worst.p99, 0.3) << "or this shows nothing";
  EXPECT_FALSE(is_good(best));
  EXPECT_GT(best.worst.largest, 0.19);
  EXPECT_LT(best.worst.largest, 0.8 * advice.own.worst.largest);
  const auto excess = [](const Trial& trial) {
    return std::max(trial.worst.p99 / tolerated_p99, trial.worst.largest / tolerated_overstretch);
  };
  for (const Trial& trial : advice.others) EXPECT_TRUE(!trial.complete || excess(trial) >= excess(best));
  const std::string words = "of " + std::to_string(advice.others.size()) +
                            " other settings tried none keeps all edges within 10 % and 99 in 100 within 2 %";
  EXPECT_EQ(advice.what_to_do.rfind(words, 0), 0U) << advice.what_to_do;
  EXPECT_NE(advice.what_to_do.find("; the best of them, "), std::string::npos) << advice.what_to_do;
}

/// A force field that makes anything infinite that hangs too low. Settings that keep lengths must do so to the end of
/// the scene, not only up to where the scene's own settings had to stop.
TEST(Advise, RunsOthersBeyondWhereTheSceneIsNotFinite) {
  Scene scene = hanging_sheet(12, Stiffness::rigid(), 1);
  scene.frames = 40;
  scene.forces.push_back([](const Vec3f& p, const Vec3f&, float, float) {
    return Vec3f{p.y < -1.15f ? 3e38f : 0, 0, 0};
  });
  const Advice advice = advise(scene, unhurried);
  EXPECT_NE(advice.words.find("not finite"), std::string::npos) << advice.words;
  EXPECT_LT(advice.own.frames, scene.frames);
  ASSERT_GE(advice.best, 0);
  EXPECT_EQ(advice.others[advice.best].frames, scene.frames);
  EXPECT_EQ(advice.what_to_do.find("only the first"), std::string::npos) << advice.what_to_do;
}

TEST(Advise, NeverNamesWhatMeasuredWorse) {
  const auto trial = [](double largest, double p99, double milliseconds, bool complete = true) {
    Trial made;
    made.worst.largest = largest;
    made.worst.p99 = p99;
    made.milliseconds = milliseconds;
    made.complete = complete;
    return made;
  };
  Advice advice;
  advice.own = trial(1, 0.2, 1);
  EXPECT_EQ(best_of(advice), -1);
  advice.others = {trial(0.5, 0.3, 1), trial(0.9, 0.1, 1), trial(0.4, 0.1, 1, false)};
  EXPECT_EQ(best_of(advice), -1) << "more all over, hardly less, and not run to its end";
  advice.others.push_back(trial(0.5, 0.1, 9));
  advice.others.push_back(trial(0.6, 0.1, 1));
  EXPECT_EQ(best_of(advice), 3) << "the nearest";
  advice.others.push_back(trial(0.1, 0.02, 9));
  advice.others.push_back(trial(0.09, 0.001, 10));
  EXPECT_EQ(best_of(advice), 5) << "the cheapest that is good";
}

TEST(Advise, SaysWhatIsNotFinite) {
  Scene scene = hanging_sheet(6, Stiffness::rigid(), 2);
  scene.forces.push_back([](const Vec3f&, const Vec3f&, float, float time) {
    return Vec3f{time > 0.1f ? 3e38f : 0, 0, 0};
  });
  const Advice advice = advise(scene, unhurried);
  EXPECT_FALSE(is_good(advice.own));
  EXPECT_FALSE(advice.own.complete);
  EXPECT_NE(advice.words.find("not finite"), std::string::npos) << advice.words;
  EXPECT_EQ(advice.best, -1);
}

TEST(Advise, GivesTheSameFiguresAgain) {
  const Scene scene = hanging_sheet(10, Stiffness::rigid(), 3);
  const Advice first = advise(scene, unhurried), second = advise(scene, {1e6, 30, {}});
  EXPECT_EQ(first.words, second.words);
  EXPECT_EQ(first.own.worst.largest, second.own.worst.largest);
  ASSERT_FALSE(first.others.empty());
  EXPECT_EQ(first.others[0].worst.largest, second.others[0].worst.largest);
}

}  // namespace
}  // namespace pliant
