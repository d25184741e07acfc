// Tests the words of advice, and which sweeps advice tries.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "advise/advise_support.h"
#include "matter/advice_settings.h"
#include "world/advice.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(Words, SayWhereAndHowMuch) {
  Scene scene;
  Object object = chain(20, 0.1f);
  object.name = "leash";
  object.pins = {{0, {}}};
  object.attachments.push_back({19, {3, 0, 0}, {}, Stiffness::rigid()});
  scene.add(object);
  const World world(scene);
  EXPECT_EQ(world.measure().describe({0.031, 0.144, 0, {0, 1}}),
            "object 'leash': stretched 14 % too far at its pins (edge 0-1), 1 edge in 100 by 3.1 % or more");
  EXPECT_EQ(world.measure().describe({0, 0.144, 0, {2, 1}}),
            "object 'leash': stretched 14 % too far near its pins (edge 2-1)");
  EXPECT_EQ(world.measure().describe({0, 2, 0, {3, 4}}),
            "object 'leash': stretched 200 % too far near its pins (edge 3-4)");
  EXPECT_EQ(world.measure().describe({0, 0.02, 0, {4, 5}}), "object 'leash': stretched 2 % too far (edge 4-5)");
  EXPECT_EQ(world.measure().describe({0, 0.02, 0, {18, 19}}), "object 'leash': stretched 2 % too far (edge 18-19)")
      << "a target is no pin";
}

TEST(Words, OfAReportComeFromItsFigures) {
  Scene scene = weight_on(Stiffness::rigid());
  scene.settings = settings_of(7);
  World world(scene);
  Report report = world.step(dt);
  EXPECT_EQ(world.measure().advice(report), "");
  report.overstretch = Overstretch{0, 0.2, 0, {{0, 1}}};
  EXPECT_EQ(
      world.measure().advice(report),
      "object 'chain': stretched 20 % too far at its pins (edge 0-1); the default, with no \"sweep\" and \"substeps\" "
      "in the scene's \"settings\", may reduce it: 'pliant check' or advise() finds out");
  report.overstretch = Overstretch{tolerated_p99, tolerated_overstretch, 0, {{0, 1}}};
  EXPECT_EQ(world.measure().advice(report), "");
  report.overstretch->p99 = 0.021;
  EXPECT_NE(world.measure().advice(report).find("1 edge in 100 by 2.1 % or more"), std::string::npos)
      << world.measure().advice(report);
  report.overstretch.reset();
  EXPECT_EQ(world.measure().advice(report), "") << "nothing measured";
}

/// What World::advice recommends to a scene of which an edge is far too long.
std::string recommended(const Scene& scene) {
  const std::string words = World(scene).measure().advice(Overstretch{0.5, 0.5, 0, {{0, 1}}}), after = " or more; ";
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

/// A larger lower bound of substeps is not the default, although both leave the substeps open.
TEST(Words, TellALargerLowerBoundFromTheDefault) {
  Advice advice;
  advice.frames = advice.own.frames = 10;
  advice.own.complete = true;
  advice.own.worst.largest = advice.own.worst.p99 = 0.5;
  Trial bounded = advice.own;
  bounded.worst = {};
  bounded.settings.least_substeps = 48;
  advice.others = {bounded};
  advice.best = 0;
  const std::string words = remedy(advice, {});
  EXPECT_EQ(words.rfind("at least 48 substeps (", 0), 0U) << words;
  EXPECT_NE(words.find(R"({"least_substeps": 48})"), std::string::npos) << words;
}

/// Multigrid ignores bending and makes a stiff sheet oscillate, and gains energy where surfaces touch, so it is not
/// tried.
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

TEST(Words, HaveNoPowersOfTen) {
  EXPECT_EQ(two_digits(0.00834), "0.0083");
  EXPECT_EQ(two_digits(9.94), "9.9");
  EXPECT_EQ(two_digits(99.4), "99");
  EXPECT_EQ(two_digits(118.2), "118");
  EXPECT_EQ(two_digits(123456), "123456");
  EXPECT_EQ(percent(0.034), "3.4 %");
}

}  // namespace
}  // namespace pliant
