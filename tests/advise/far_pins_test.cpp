// Tests the advice where no settings can keep an object's lengths, because its pins are farther apart than it is long.
#include <gtest/gtest.h>

#include <string>

#include "advise/advise_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A sheet of 1 m whose second corner moves away from the first in 0.2 s.
Scene pulled_apart(float by, bool by_attachments = false) {
  Scene scene = hanging_sheet(12, Stiffness::rigid(), 0);
  scene.settings = settings_of(0);
  scene.settings.sweep = Sweep::automatic;
  Object& sheet = scene.objects[0];
  sheet.pins[1].motion = straight({by, 0, 0}, 0.2f);
  if (!by_attachments) return scene;
  for (const Pin& pin : sheet.pins)
    sheet.attachments.push_back(
        {pin.particle, sheet.positions[static_cast<std::size_t>(pin.particle)], pin.motion, Stiffness::rigid()});
  sheet.pins.clear();
  return scene;
}

TEST(FarPins, AreNamedInsteadOfMoreSubsteps) {
  for (const bool by_attachments : {false, true}) {
    const Advice advice = advise(pulled_apart(0.3f, by_attachments), unhurried);
    EXPECT_FALSE(advice.words.empty());
    EXPECT_TRUE(advice.others.empty()) << "no other settings help";
    const std::string& text = advice.what_to_do;
    EXPECT_EQ(text.rfind("no settings keep its lengths: particles 0 and 11, which are pinned or attached, are 1.", 0),
              0U)
        << text;
    EXPECT_NE(text.find("and the object between them is only 1 m long"), std::string::npos) << text;
  }
}

TEST(FarPins, AreNotNamedWhereTheyStayWithinReach) {
  Scene scene = pulled_apart(0.01f);
  scene.settings = settings_of(1);  // a poor setting, so that there is something to advise
  EXPECT_FALSE(advise(scene, unhurried).others.empty());
}

/// Along a rope that is folded in zigzags, pins may be moved apart to its full length.
TEST(FarPins, AreComparedAlongTheObject) {
  for (const float by : {0.9f, 1.4f}) {
    Scene scene;
    std::vector<Vec3f> points;
    for (int i = 0; i <= 40; ++i)
      points.push_back({0.015f * static_cast<float>(i), 0.02f * static_cast<float>(i % 2), 0});
    const int rope = scene.add(make_rope(points));  // 40 links of 25 mm, its ends 0.6 m apart
    scene.pin(rope, {0});
    scene.pin(rope, {40}, straight({by - 0.6f, 0, 0}, 0.2f));
    scene.settings = settings_of(1);
    scene.frames = 30;
    const Advice advice = advise(scene, unhurried);
    EXPECT_EQ(advice.what_to_do.rfind("no settings", 0) == 0, by > 1) << by << ": " << advice.what_to_do;
  }
}

}  // namespace
}  // namespace pliant
