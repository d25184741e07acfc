// Tests the warnings that a trial of the scene's own settings gives.
#include <gtest/gtest.h>

#include <string>

#include "advise/advise_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A sheet of 0.6 m that drops over a thin bar, so that its halves meet below.
Scene over_a_bar(bool self_collision) {
  Scene scene;
  ClothOptions options;
  options.name = "towel";
  TriangleMesh mesh = grid_mesh(24, 24, 0.6f, 0.6f);
  for (Vec3f& p : mesh.positions) p.y = 0.1f;
  scene.add_cloth(mesh, options);
  scene.objects[0].self_collision = self_collision;
  scene.objects[0].thickness = 0.004f;
  Collider bar;
  bar.shape = Capsule{0.01f, 0.5f};
  bar.rotation = rotation({1, 0, 0}, 90);
  scene.add(bar);
  scene.frames = 60;
  return scene;
}

TEST(Warnings, OfATrialNameClothThatPassesThroughItself) {
  const Advice advice = advise(over_a_bar(false), unhurried);
  ASSERT_EQ(advice.warnings.size(), 1U);
  const std::string& words = advice.warnings[0];
  EXPECT_EQ(words.rfind("frame 60: object 'towel': edge ", 0), 0U) << words;
  EXPECT_NE(words.find("set its \"self_collision\" to true"), std::string::npos) << words;
  EXPECT_EQ(advise(over_a_bar(true), unhurried).warnings, std::vector<std::string>{});
}

/// Two sheets that fall towards each other's places, the lower one upwards.
Scene changing_places(bool first_collides, bool second_collides) {
  Scene scene;
  for (const float side : {1.f, -1.f}) {
    ClothOptions options;
    options.name = side > 0 ? "upper" : "lower";
    options.velocity = {0, -side, 0};
    TriangleMesh mesh = grid_mesh(8, 8, 0.6f, 0.6f);
    for (Vec3f& p : mesh.positions) p = p + Vec3f{0.01f * side, side * (0.045f + 0.1f * p.x), 0};
    scene.add_cloth(mesh, options);
    scene.objects.back().thickness = 0.004f;
  }
  scene.objects[0].collides = first_collides;
  scene.objects[1].collides = second_collides;
  scene.frames = 3;
  scene.gravity = {0, 0, 0};
  return scene;
}

TEST(Warnings, OfATrialNameObjectsThatPassThroughEachOther) {
  const std::vector<std::string> warnings = advise(changing_places(true, false), unhurried).warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].rfind("frame 3: object 'upper' passes through object 'lower' in ", 0), 0U) << warnings[0];
  EXPECT_NE(warnings[0].find("set \"collides\" of 'lower' to true"), std::string::npos) << warnings[0];
  EXPECT_EQ(advise(changing_places(true, true), unhurried).warnings, std::vector<std::string>{});
}

/// When all is over they are apart again, and neither crosses anything in the last frame.
TEST(Warnings, OfATrialNameObjectsThatHavePassedThroughEachOther) {
  Scene scene = changing_places(false, false);
  scene.frames = 30;
  const std::vector<std::string> warnings = advise(scene, unhurried).warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].rfind("frame 4: object 'upper' passes through object 'lower' in ", 0), 0U) << warnings[0];
}

TEST(Warnings, AreNotGivenWhereNothingCanMove) {
  Scene scene = changing_places(false, false);
  for (Object& object : scene.objects) {
    for (std::size_t p = 0; p < object.positions.size(); ++p)
      object.pins.push_back({static_cast<int>(p), straight({0, object.name == "upper" ? -0.5f : 0.5f, 0}, 0.1f)});
    object.velocities.clear();
  }
  EXPECT_EQ(advise(scene, unhurried).warnings, std::vector<std::string>{});
}

TEST(Warnings, AreNotGivenWhereMasksKeepObjectsApart) {
  Scene scene = changing_places(false, false);
  EXPECT_EQ(advise(scene, unhurried).warnings.size(), 1U);
  scene.objects[0].groups = 2;
  scene.objects[1].mask = 1;
  EXPECT_EQ(advise(scene, unhurried).warnings, std::vector<std::string>{});
}

/// A mesh that crosses itself at the start is named by inspect(); the run adds nothing.
TEST(Warnings, DoNotRepeatWhatCrossesAtTheStart) {
  Scene scene = over_a_bar(false);
  scene.objects[0].positions[0] = scene.objects[0].positions[100] - Vec3f{0, 0.05f, 0};
  scene.objects[0].positions[1] = scene.objects[0].positions[100] + Vec3f{0.01f, 0.05f, 0};
  EXPECT_EQ(advise(scene, unhurried).warnings, std::vector<std::string>{});
}

/// Layers at distance 0 have no side; the run's own warnings say so.
TEST(Warnings, OfTheFramesAreKeptOncePerKind) {
  Scene scene = over_a_bar(true);
  // What is pinned stays where it is, so both touch there.
  for (const int particle : {0, 1, 2}) scene.objects[0].pins.push_back({.particle = particle});
  Object copy = scene.objects[0];
  scene.objects[0].name = "one";
  copy.name = "two";
  scene.objects[0].collides = copy.collides = true;
  scene.objects.push_back(copy);
  scene.frames = 3;
  const Advice advice = advise(scene, unhurried);
  ASSERT_FALSE(advice.warnings.empty());
  EXPECT_EQ(advice.warnings[0].rfind("frame 1: object 'one' and object 'two': ", 0), 0U) << advice.warnings[0];
  EXPECT_NE(advice.warnings[0].find("unresolvable"), std::string::npos) << advice.warnings[0];
}

TEST(Warnings, ThatDifferOnlyInNumbersAreOfOneKind) {
  WarningLog log;
  Report report;
  report.warnings = {"vertex 3 is at 1.5 m", "other"};
  report.frame = 1;
  log.add(report);
  report.warnings = {"vertex 41 is at 2 m", "another"};
  report.frame = 2;
  log.add(report);
  EXPECT_EQ(log.lines(),
            (std::vector<std::string>{"frame 1: vertex 3 is at 1.5 m", "frame 1: other", "frame 2: another"}));
}

/// The lines that a log keeps of warnings of one frame.
std::size_t kept(const std::vector<std::string>& warnings) {
  WarningLog log;
  Report report;
  report.warnings = warnings;
  log.add(report);
  return log.lines().size();
}

TEST(Warnings, OfObjectsWhoseNamesDifferInDigitsAreOfTwoKinds) {
  EXPECT_EQ(kept({"object 'sheet1': edge 3-4", "object 'sheet2': edge 3-4", "object 'sheet1': edge 5-61"}), 2U);
  EXPECT_EQ(kept({"\"1.5\" is far", "\"2.5\" is far"}), 2U);
  EXPECT_EQ(kept({"object 'Ann's 1' at 2", "object 'Ann's 2' at 2", "object 'Ann's 2' at 3"}), 2U);
  EXPECT_EQ(kept({"the sheet's 1 of the ball's 2", "the sheet's 3 of the ball's 4"}), 1U)
      << "apostrophes quote nothing";
  EXPECT_EQ(kept({"' 1", "' 2"}), 1U) << "nor does a quote without its end";
}

TEST(Warnings, OfNumbersWithSignFractionOrExponentAreOfOneKind) {
  EXPECT_EQ(kept({"moves 0.5 m", "moves -0.5 m", "moves 7 m", "moves 2e-05 m", "moves +1.25e+3 m"}), 1U);
  EXPECT_EQ(kept({"moves 3 edges", "moves 3. edges", "moves - edges", "moves edges"}), 4U) << "what is no number stays";
}

}  // namespace
}  // namespace pliant
