// Tests the overstretch that a Report measures, by known answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "advise/advise_support.h"

namespace pliant {
namespace {

using namespace testing_support;

Settings measuring(int substeps, int iterations = 1) {
  Settings settings = settings_of(substeps, iterations);
  settings.measure = true;
  return settings;
}

TEST(Overstretch, OfRigidLinksIsTheirStretch) {
  Scene scene;
  Object object = chain(5, 0.1f);
  object.constraints[0].rest = {0.1f, 0.1f, 0.08f, 0.1f};
  scene.add(object);
  const Overstretch found = World(scene).measure().overstretch();
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
      EXPECT_EQ(world.measure().advice(report), "");
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
  EXPECT_EQ(world.measure().advice(report), "");
  EXPECT_EQ(world.measure().describe(*report.overstretch), "");
}

TEST(Overstretch, LeavesOneInAHundredAbove) {
  Scene scene;
  Object object = chain(301, 0.1f);
  object.constraints[0].rest.assign(300, 0.1f);
  for (int i : {7, 100, 222}) object.constraints[0].rest[i] = 0.05f;
  for (int i : {20, 21}) object.constraints[0].rest[i] = 0.099f;
  scene.add(object);
  const Overstretch found = World(scene).measure().overstretch();
  EXPECT_NEAR(found.largest, 1, 1e-3);
  EXPECT_NEAR(found.p99, 0.0101, 1e-3);
}

}  // namespace
}  // namespace pliant
