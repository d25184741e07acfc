// Tests that contacts are found again within a frame for some bodies alone.
#include "collision/bodies/body_contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "collision/random_support.h"

namespace pliant {
namespace {

constexpr float dt = 1.f / 60;

class BodyScene {
 public:
  std::vector<BodyState> states;
  std::vector<BodyContact> contacts;

  void add_ball(float radius, const Vec3d& place, const Vec3f& velocity = {}) {
    const int number = static_cast<int>(states.size());
    parts_.push_back({{0, number, 0}, number, {ConvexShape::Kind::point, radius, 0, 0, nullptr}, false, {}});
    states.push_back({{place, {}}, velocity, {}});
  }
  /// Before any ball: what is below its height.
  void add_ground(double height) {
    parts_.push_back({{-1, 0, 0}, 0, {}, true, {}});
    states.push_back({{{0, height, 0}, {}}, {}, {}});
    states.back().is_fixed = true;
  }
  void update() {
    if (finder_.parts().empty()) finder_ = BodyContacts(parts_);
    finder_.update(executor_, states, dt, 0, all_meet, contacts, contacts);
  }
  /// Nonzero `of`: those that are found again.
  void renew(const std::vector<char>& of, float far = 1e30f, BodyContacts::Again again = BodyContacts::Again::all) {
    std::vector<BodyContacts::Again> which(of.size(), BodyContacts::Again::none);
    for (std::size_t i = 0; i < of.size(); ++i)
      if (of[i] != 0) which[i] = again;
    finder_.renew(executor_, states, dt, 0, all_meet, which, far, contacts);
  }

 private:
  static constexpr auto all_meet = [](int, int) { return true; };

  std::vector<BodyPart> parts_;
  BodyContacts finder_;
  Executor executor_{1};
};

/// Two pairs of balls, far from one another.
BodyScene two_pairs() {
  BodyScene scene;
  for (const double x : {0., 0.202, 10., 10.202}) scene.add_ball(0.1f, {x, 0, 0});
  scene.update();
  return scene;
}

TEST(BodyContacts, OnlyThoseOfRenewedBodiesAreFoundAgain) {
  BodyScene scene = two_pairs();
  ASSERT_EQ(scene.contacts.size(), 2u);
  for (const int i : {1, 3}) scene.states[std::size_t(i)].pose.position += Vec3d{-0.001, 0.03, 0};
  scene.renew({0, 1, 0, 0});
  ASSERT_EQ(scene.contacts.size(), 2u);
  EXPECT_NEAR(scene.contacts[0].normal.y, 0.03 / std::hypot(0.201, 0.03), 1e-4);
  EXPECT_EQ(scene.contacts[1].normal.y, 0);
  EXPECT_NEAR(scene.contacts[1].gap[0], 0.001, 1e-5) << "the gap is that of now";
}

TEST(BodyContacts, ThoseOfOthersAreFoundAgainIfTheyMovedFar) {
  BodyScene scene = two_pairs();
  scene.states[1].pose.position.y += 0.005;
  scene.states[3].pose.position.y += 0.015;
  scene.renew({0, 0, 0, 0}, 0.1f);
  ASSERT_EQ(scene.contacts.size(), 2u);
  EXPECT_EQ(scene.contacts[0].normal.y, 0);
  EXPECT_GT(scene.contacts[1].normal.y, 0.05);
}

TEST(BodyContacts, ARenewedBodyMeetsWhatWasOutOfReach) {
  BodyScene scene = two_pairs();
  scene.states[1].velocity = {600, 0, 0};
  scene.renew({0, 0, 0, 0});
  EXPECT_EQ(scene.contacts.size(), 2u);
  scene.renew({0, 1, 0, 0});
  ASSERT_EQ(scene.contacts.size(), 4u) << "with both of the other pair, too";
  EXPECT_EQ(scene.contacts[1].a.solid, 1);
  EXPECT_EQ(scene.contacts[1].b.solid, 2);
}

TEST(BodyContacts, OfWhatRollsOnlyThoseThatTouchAreFoundAgain) {
  BodyScene scene = two_pairs();
  scene.states[1].velocity = {600, 0, 0};
  for (const int i : {1, 3}) scene.states[std::size_t(i)].pose.position += Vec3d{-0.001, 0.03, 0};
  scene.renew({0, 1, 0, 1}, 1e30f, BodyContacts::Again::touching);
  ASSERT_EQ(scene.contacts.size(), 2u) << "what was out of reach is not met";
  for (const BodyContact& c : scene.contacts) EXPECT_NEAR(c.normal.y, 0.03 / std::hypot(0.201, 0.03), 1e-4);
  for (const int i : {1, 3}) scene.states[std::size_t(i)].pose.position += Vec3d{0.02, 0.03, 0};
  scene.renew({0, 0, 0, 0});  // gaps of now, which are wide
  scene.states[3].pose.position += Vec3d{-0.03, 0, 0};
  scene.renew({0, 1, 0, 1}, 1e30f, BodyContacts::Again::touching);
  for (const BodyContact& c : scene.contacts) EXPECT_NEAR(c.normal.y, 0.03 / std::hypot(0.201, 0.03), 1e-4);
}

/// Balls that overlap by chance, of which half turn around within the frame: so few of them that the tree is asked, or
/// many. They are slow: the direction of a contact of what is fast follows from what both touch first, which is known
/// only of bodies that are renewed.
TEST(BodyContacts, RenewedOnesAreThoseOfANewSearch) {
  for (const int every : {10, 2, 1}) {
    testing_support::Random random(7);
    BodyScene once, again;
    std::vector<char> of;
    for (int i = 0; i < 400; ++i) {
      const Vec3d at = testing_support::random_place(random, 1);
      const Vec3f before = convert<float>(testing_support::random_place(random, 0.05));
      const Vec3f after = convert<float>(testing_support::random_place(random, 0.05));
      const bool turns = i % every == 0;
      again.add_ball(0.1f, at, before);
      once.add_ball(0.1f, at, turns ? after : before);
      of.push_back(turns ? 1 : 0);
    }
    again.update();
    for (std::size_t i = 0; i < of.size(); ++i) again.states[i].velocity = once.states[i].velocity;
    again.contacts.clear();
    again.renew(std::vector<char>(of.size(), 0));
    EXPECT_TRUE(again.contacts.empty());
    again.renew(of);
    once.update();
    std::size_t found = 0;
    for (const BodyContact& c : once.contacts) {
      if (of[std::size_t(c.a.solid)] == 0 && of[std::size_t(c.b.solid)] == 0) continue;
      ASSERT_LT(found, again.contacts.size());
      EXPECT_EQ(again.contacts[found].a, c.a);
      EXPECT_EQ(again.contacts[found].b, c.b);
      EXPECT_EQ(again.contacts[found++].gap, c.gap);
    }
    EXPECT_EQ(found, again.contacts.size());
    EXPECT_GT(found, 50u);
  }
}

/// A State that is restored has a new tree of boxes, and goes on with the same bits.
void expect_the_same_with_an_old_tree(bool again) {
  BodyScene fresh, old;
  std::vector<char> of{1};
  for (BodyScene* scene : {&fresh, &old}) {
    testing_support::Random random(7);
    scene->add_ground(-1.2);
    for (int i = 0; i < 400; ++i) scene->add_ball(0.1f, testing_support::random_place(random, 1));
  }
  for (int i = 0; i < 400; ++i)
    of.push_back(i % 4 == 0 ? 1 : 0);  // so many that with a new tree, which they leave, it is not asked
  const auto set_speed = [&](BodyScene& scene, float speed) {
    for (std::size_t i = 1; i < of.size(); ++i)
      if (of[i] != 0) scene.states[i].velocity = {speed, 0.5f * speed, 0};
  };
  set_speed(old, 30);
  old.update();
  old.contacts.clear();
  for (BodyScene* scene : {&fresh, &old}) {
    set_speed(*scene, 0);
    scene->update();
    scene->states[0].pose.position.y = -0.9;
    set_speed(*scene, 30);
    scene->renew(of);
    if (!again) continue;
    // Those that have just left their boxes come to rest, and meet others that are renewed alone.
    std::vector<char> others(of.size(), 0);
    for (std::size_t i = 1; i < of.size(); ++i) others[i] = i % 16 == 3 ? 1 : 0;
    scene->renew(others);
  }
  ASSERT_EQ(fresh.contacts.size(), old.contacts.size());
  ASSERT_GT(fresh.contacts.size(), 500u);
  for (std::size_t i = 0; i < old.contacts.size(); ++i) {
    EXPECT_EQ(fresh.contacts[i].a, old.contacts[i].a);
    EXPECT_EQ(fresh.contacts[i].b, old.contacts[i].b);
    EXPECT_EQ(fresh.contacts[i].gap, old.contacts[i].gap);
  }
}

TEST(BodyContacts, RenewalDoesNotDependOnWhenTheTreeWasBuilt) { expect_the_same_with_an_old_tree(false); }

TEST(BodyContacts, ASecondRenewalInAFrameFindsWhatTheFirstHasMoved) { expect_the_same_with_an_old_tree(true); }

}  // namespace
}  // namespace pliant
