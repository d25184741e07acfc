// Tests overstretch and advice: measured values compared with known answers, the words, and settings that were really
// tried.
#include "pliant/advise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "matter/advice_settings.h"
#include "support/scenes.h"
#include "world/advice.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float dt = 1.f / 60;
const AdviseOptions unhurried{1e6, 120, {}};

Settings measuring(int substeps, int iterations = 1) {
  Settings settings = settings_of(substeps, iterations);
  settings.measure = true;
  return settings;
}

/// A weight of 1 kg that hangs on a pin by one link of 1 m.
Scene weight_on(const Stiffness& stiffness) {
  Scene scene;
  Object object = chain(2, 1, stiffness);
  object.positions[1] = {0, -1, 0};
  object.pins = {{0, {}}};
  scene.add(object);
  return scene;
}

// ---------------------------------------------------------------- the measure

TEST(Overstretch, OfRigidLinksIsTheirStretch) {
  Scene scene;
  Object object = chain(5, 0.1f);
  object.constraints[0].rest = {0.1f, 0.1f, 0.08f, 0.1f};
  scene.add(object);
  const Overstretch found = World(scene).overstretch();
  EXPECT_NEAR(found.largest, 0.25, 1e-6);
  EXPECT_EQ(found.object, 0);
  EXPECT_EQ(found.particles[0] + found.particles[1], 5);
  EXPECT_EQ(std::abs(found.particles[0] - found.particles[1]), 1) << "particles 2 and 3, in either order";
}

TEST(Overstretch, OfWhatIsMeantToStretchIsNothing) {
  for (float damping : {0.f, 0.2f}) {
    Scene scene = weight_on(Stiffness::compliance(0.05f, damping));  // 0.49 m longer at rest; swings up and down
    World world(scene, measuring(10));
    double longest = 1;
    for (int frame = 0; frame < 120; ++frame) {
      const Report report = world.step(dt);
      longest = std::max(longest, report.stretch->largest);
      EXPECT_NEAR(report.overstretch->largest, 0, 2e-4) << "frame " << frame << ", damping " << damping;
      EXPECT_EQ(world.advice(report), "");
    }
    EXPECT_GT(longest, 1.4) << "or this shows nothing";
  }
}

TEST(Overstretch, SeesAForceThatWasNotReached) {
  Scene scene;
  Object object = chain(30, 0.1f, Stiffness::compliance(1e-7f));
  object.pins = {{0, {}}};
  scene.add(object);
  World few(scene, measuring(2)), many(scene, measuring(200, 4));
  double left_by_few = 0, left_by_many = 0;
  for (int frame = 0; frame < 60; ++frame) {
    left_by_few = std::max(left_by_few, few.step(dt).overstretch->largest);
    left_by_many = std::max(left_by_many, many.step(dt).overstretch->largest);
  }
  EXPECT_GT(left_by_few, 0.05);
  EXPECT_LT(left_by_many, 0.005);
}

TEST(Overstretch, LeavesOutPbdAndWhatHasNoLength) {
  Scene scene = weight_on(Stiffness::pbd(0.01f));
  scene.objects[0].attachments.push_back({1, {0, -3, 0}, {}, Stiffness::rigid()});
  World world(scene, measuring(2));
  const Report report = world.step(dt);
  EXPECT_GT(report.stretch->largest, 1.5);
  EXPECT_EQ(report.overstretch->object, -1);
  EXPECT_EQ(world.advice(report), "");
  EXPECT_EQ(world.describe(*report.overstretch), "");
}

TEST(Overstretch, LeavesOneInAHundredAbove) {
  Scene scene;
  Object object = chain(301, 0.1f);
  object.constraints[0].rest.assign(300, 0.1f);
  for (int i : {7, 100, 222}) object.constraints[0].rest[i] = 0.05f;
  for (int i : {20, 21}) object.constraints[0].rest[i] = 0.099f;
  scene.add(object);
  const Overstretch found = World(scene).overstretch();
  EXPECT_NEAR(found.largest, 1, 1e-3);
  EXPECT_NEAR(found.p99, 0.0101, 1e-3);
}

// ---------------------------------------------------------------- words

TEST(Words, SayWhereAndHowMuch) {
  Scene scene;
  Object object = chain(20, 0.1f);
  object.name = "leash";
  object.pins = {{0, {}}};
  object.attachments.push_back({19, {3, 0, 0}, {}, Stiffness::rigid()});
  scene.add(object);
  const World world(scene);
  EXPECT_EQ(world.describe({0.031, 0.144, 0, {0, 1}}),
            "object 'leash': stretched 14 % too far at its pins (edge 0-1), 1 edge in 100 by 3.1 % or more");
  EXPECT_EQ(world.describe({0, 0.144, 0, {2, 1}}), "object 'leash': stretched 14 % too far near its pins (edge 2-1)");
  EXPECT_EQ(world.describe({0, 2, 0, {3, 4}}), "object 'leash': stretched 200 % too far near its pins (edge 3-4)");
  EXPECT_EQ(world.describe({0, 0.02, 0, {4, 5}}), "object 'leash': stretched 2 % too far (edge 4-5)");
  EXPECT_EQ(world.describe({0, 0.02, 0, {18, 19}}), "object 'leash': stretched 2 % too far (edge 18-19)")
      << "a target is no pin";
}

TEST(Words, OfAReportComeFromItsFigures) {
  Scene scene = weight_on(Stiffness::rigid());
  scene.settings = settings_of(7);
  World world(scene);
  Report report = world.step(dt);
  EXPECT_EQ(world.advice(report), "");
  report.overstretch = Overstretch{0, 0.2, 0, {{0, 1}}};
  EXPECT_EQ(
      world.advice(report),
      "object 'chain': stretched 20 % too far at its pins (edge 0-1); the default, with no \"sweep\" and \"substeps\" "
      "in the scene's \"settings\", may reduce it: 'pliant check' or advise() finds out");
  report.overstretch = Overstretch{tolerated_p99, tolerated_overstretch, 0, {{0, 1}}};
  EXPECT_EQ(world.advice(report), "");
  report.overstretch->p99 = 0.021;
  EXPECT_NE(world.advice(report).find("1 edge in 100 by 2.1 % or more"), std::string::npos) << world.advice(report);
  report.overstretch.reset();
  EXPECT_EQ(world.advice(report), "") << "nothing measured";
}

/// What World::advice recommends to a scene of which an edge is far too long.
std::string recommended(const Scene& scene) {
  const std::string words = World(scene).advice(Overstretch{0.5, 0.5, 0, {{0, 1}}}), after = " or more; ";
  const std::size_t from = words.find(after) + after.size();
  return words.substr(from, words.find(" may reduce it") - from);
}

TEST(Words, RecommendTheDefaultOnlyWhereTheSceneDepartsFromIt) {
  const std::string by_default = "the default, with no \"sweep\" and \"substeps\" in the scene's \"settings\",";
  Scene scene;
  scene.add_cloth(grid_mesh(5, 5, 1, 1), {});
  EXPECT_EQ(recommended(scene), "more than 20 substeps");
  scene.settings = settings_of(20);
  EXPECT_EQ(recommended(scene), "more than 20 substeps") << "named, but the same";
  scene.settings.substeps = 10;
  EXPECT_EQ(recommended(scene), by_default);
  scene.settings = {};
  scene.settings.sweep = Sweep::multigrid;
  EXPECT_EQ(recommended(scene), "the default, with no \"sweep\" in the scene's \"settings\",");
  Scene large;
  large.add_cloth(grid_mesh(24, 24, 1, 1), {});
  EXPECT_EQ(recommended(large), "a larger \"least_substeps\" or \"most_substeps\"");
  large.settings.substeps = 30;
  EXPECT_EQ(recommended(large), "the default, with no \"substeps\" in the scene's \"settings\",");
  large.settings.substeps = 0;
  large.settings.most_substeps = 15;
  EXPECT_EQ(recommended(large), "the default, with no \"most_substeps\" in the scene's \"settings\",");
  large.settings.sweep = Sweep::chains;
  large.settings.least_substeps = 5;
  EXPECT_EQ(recommended(large),
            "the default, with no \"sweep\", \"least_substeps\" and \"most_substeps\" in the scene's \"settings\",");
}

/// If the scene names no substeps, sets of objects can have different numbers; advice for all must name the largest.
TEST(Words, NameSubstepsThatTheSceneLeavesOpen) {
  Settings wanted, own;
  wanted.sweep = Sweep::multigrid;
  own.sweep = Sweep::tiled;
  EXPECT_EQ(in_json(wanted, own), R"({"substeps": 20, "sweep": "multigrid"})");
  wanted = own;
  wanted.least_substeps = 48;
  EXPECT_EQ(in_json(wanted, own), R"({"least_substeps": 48})");
  own.most_substeps = 15;
  wanted.most_substeps = 48;
  EXPECT_EQ(in_json(wanted, own), R"({"least_substeps": 48, "most_substeps": 48})");
}

/// Multigrid ignores bending and makes a stiff sheet oscillate, and gains energy where surfaces touch, so it is not tried.
TEST(BetterSweeps, BeginWithTheDefaultAndLeaveOutMultigridWhereItDoesHarm) {
  Scene scene;
  scene.add_cloth(grid_mesh(20, 20, 1, 1), {});
  scene.settings.sweep = Sweep::tiled;
  EXPECT_EQ(better_sweeps(scene), (std::vector<Sweep>{Sweep::chains, Sweep::multigrid}));
  Scene touching = scene;
  touching.objects[0].self_collision = true;
  EXPECT_EQ(better_sweeps(touching), std::vector<Sweep>{Sweep::chains});
  Scene meeting = scene;
  meeting.add(Collider{});
  EXPECT_EQ(better_sweeps(meeting), std::vector<Sweep>{Sweep::chains}) << "cloth sticks to colliders by multigrid";
  ClothOptions options;
  options.material.bending_stiffness = 5;
  Scene stiff;
  stiff.add_cloth(grid_mesh(20, 20, 1, 1), options);
  stiff.settings.sweep = Sweep::tiled;
  EXPECT_EQ(better_sweeps(stiff), std::vector<Sweep>{Sweep::chains});
}

// ---------------------------------------------------------------- trials

Scene hanging_sheet(int n, const Stiffness& stretch, int substeps) {
  Scene scene;
  ClothOptions options;
  options.name = "sheet";
  options.stretch = stretch;
  scene.add_cloth(grid_mesh(n, n, 1, 1), options);
  scene.pin(0, {0, n - 1});
  scene.settings = settings_of(substeps);
  scene.frames = 30;
  return scene;
}

/// The same with the default, which several iterations make a poor one: 20 substeps of `tiled`.
Scene poor_by_default(Scene scene) {
  scene.settings = settings_of(0, 2);
  scene.settings.sweep = Sweep::automatic;
  return scene;
}

bool is_default(const Trial& trial) { return trial.settings.sweep == Sweep::automatic && trial.settings.substeps == 0; }

/// The largest stretch of any frame, measured otherwise than in a trial.
double largest_stretch(const Scene& scene, const Settings& settings) {
  World world(scene, settings);
  double largest = 1;
  for (int frame = 0; frame < scene.frames; ++frame) {
    world.step(scene.frame_time);
    largest = std::max(largest, world.stretch().largest);
  }
  return largest;
}

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
  EXPECT_NE(advice.what_to_do.find("; remove \"sweep\" and \"substeps\" from the scene's \"settings\""), std::string::npos)
      << advice.what_to_do;
}

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
  scene.add(chain(6, 0.2f));
  scene.pin(0, {0});
  scene.pin(0, {5}, straight({0.5f, 0, 0}, 0.2f));
  scene.settings = settings_of(4);
  scene.frames = 20;
  const Advice advice = advise(scene, unhurried);
  EXPECT_EQ(advice.best, -1);
  EXPECT_GT(advice.others.size(), 3U);
  const std::string tried = "of " + std::to_string(advice.others.size()) + " other settings tried none is clearly better";
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

/// A force field that makes anything infinite that hangs too low. Settings that keep lengths must do so to the end of
/// the scene, not only up to where the scene's own settings had to stop.
TEST(Advise, RunsOthersBeyondWhereTheSceneIsNotFinite) {
  Scene scene = hanging_sheet(12, Stiffness::rigid(), 1);
  scene.frames = 40;
  scene.forces.push_back([](const Vec3f& p, const Vec3f&, float, float) { return Vec3f{p.y < -1.15f ? 3e38f : 0, 0, 0}; });
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
  EXPECT_NE(advice.what_to_do.find(R"(; remove "sweep", "least_substeps" and "most_substeps" from the scene's "settings")"),
            std::string::npos)
      << advice.what_to_do;
}

/// Where the default follows the State and is not good, a larger lower bound is tried.
TEST(Advise, TriesLargerBoundsOfSubsteps) {
  Scene scene = hanging_sheet(24, Stiffness::rigid(), 0);
  scene.settings = {};
  scene.objects[0].pins[1].motion = straight({1e-3f, 0, 0}, 1);  // pins that move apart: no tethers
  scene.objects[0].self_collision = true;
  scene.gravity = {0, -3000, 0};
  scene.frames = 2;
  const Advice advice = advise(scene, unhurried);
  ASSERT_FALSE(is_good(advice.own)) << "or this shows nothing";
  std::vector<int> least;
  for (const Trial& trial : advice.others)
    if (trial.settings.substeps == 0) least.push_back(trial.settings.least_substeps);
  ASSERT_GE(least.size(), 2U);
  EXPECT_EQ(least[0], 24);
  EXPECT_EQ(least[1], 48);
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

/// Twice a bound may be no multiple of four, and bounds with none between them are refused.
TEST(Advise, TriesBoundsOfSubstepsThatAreAccepted) {
  Scene scene = hanging_sheet(24, Stiffness::rigid(), 0);
  scene.settings = {};
  scene.settings.least_substeps = 15;
  scene.settings.most_substeps = 20;
  scene.objects[0].pins[1].motion = straight({1e-3f, 0, 0}, 1);  // pins that move apart: no tethers
  scene.objects[0].self_collision = true;
  scene.gravity = {0, -3000, 0};
  scene.frames = 2;
  const Advice advice = advise(scene, unhurried);
  ASSERT_FALSE(is_good(advice.own)) << "or this shows nothing";
  const auto has_larger = [](const Trial& trial) {
    return trial.settings.least_substeps == 32 && trial.settings.most_substeps == 32;
  };
  EXPECT_TRUE(std::any_of(advice.others.begin(), advice.others.end(), has_larger));
}

/// Time is kept for other trials only where the first one found something.
TEST(Advise, UsesAllOfItsTimeForASceneThatIsFine) {
  Scene scene = hanging_sheet(8, Stiffness::rigid(), 150);
  scene.frames = 5;
  int frames = 0;
  const Advice advice = advise(scene, {4, 120, [&] {
                                         if (++frames == 1) std::this_thread::sleep_for(std::chrono::milliseconds(1300));
                                         return false;
                                       }});
  EXPECT_EQ(advice.own.frames, 5);
  EXPECT_FALSE(advice.cut_short);
}

TEST(Words, HaveNoPowersOfTen) {
  EXPECT_EQ(two_digits(0.00834), "0.0083");
  EXPECT_EQ(two_digits(9.94), "9.9");
  EXPECT_EQ(two_digits(99.4), "99");
  EXPECT_EQ(two_digits(118.2), "118");
  EXPECT_EQ(two_digits(123456), "123456");
  EXPECT_EQ(percent(0.034), "3.4 %");
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
