// Tests which bodies meet, and with which material, by applying the rule to every two bodies.
#include "collision/proxies/contact_rules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace pliant {
namespace {

ContactRules random_rules(std::uint64_t seed, int bodies, int exceptions) {
  std::mt19937_64 random(seed);
  const auto below = [&](std::uint64_t n) { return random() % n; };
  ContactRules rules;
  for (int i = 0; i < bodies; ++i) {
    ContactBody body;
    body.groups = 1u << below(3);
    body.mask = static_cast<std::uint32_t>(below(8));
    body.collides = below(4) != 0;
    body.is_collider = below(5) == 0;
    body.is_immovable = below(3) == 0;
    body.meets_itself = below(6) == 0;
    body.thickness = 1e-3f * static_cast<float>(below(20));
    rules.add(body);
  }
  for (int i = 0; i < exceptions; ++i) {
    const int a = static_cast<int>(below(bodies)), b = static_cast<int>(below(bodies));
    rules.set_material(a, b, {1e-3f * static_cast<float>(below(40)), 0.5f, 0.5f, 0});
  }
  return rules;
}

TEST(ContactRules, LargestThicknessAndWhoMeetsAnyoneAreThoseOfAllPairs) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const ContactRules rules = random_rules(seed, 1 + static_cast<int>(seed % 12), static_cast<int>(seed % 4));
    std::vector<int> among;  // all bodies, or two in three
    for (int body = 0; body < rules.bodies(); ++body)
      if (seed % 2 == 0 || (static_cast<std::uint64_t>(body) + seed) % 3 != 0) among.push_back(body);
    const std::vector<char> meeting = rules.meeting(among);
    ASSERT_EQ(meeting.size(), among.size());
    float largest = 0;
    for (std::size_t i = 0; i < among.size(); ++i) {
      const int a = among[i];
      bool meets = false;
      for (const int b : among) {
        ASSERT_EQ(rules.meet(a, b), rules.meet(b, a));
        if (!rules.meet(a, b)) continue;
        meets = true;
        largest = std::max(largest, rules.material(a, b).thickness);
      }
      ASSERT_EQ(meeting[i] != 0, meets) << seed << " " << a;
    }
    ASSERT_EQ(rules.largest_thickness(among), largest) << seed;
  }
}

TEST(ContactRules, CombineMaterialsAndKnowExceptions) {
  ContactRules rules;
  ContactBody body;
  body.thickness = 0.002f;
  body.static_friction = 0.4f;
  body.kinetic_friction = 0.1f;
  rules.add(body);
  body.thickness = 0.003f;
  body.static_friction = 0.9f;
  body.restitution = 0.5f;
  rules.add(body);
  EXPECT_FLOAT_EQ(rules.material(0, 1).thickness, 0.005f);
  EXPECT_FLOAT_EQ(rules.material(1, 0).static_friction, 0.6f);
  EXPECT_FLOAT_EQ(rules.material(0, 1).kinetic_friction, 0.1f);
  EXPECT_FLOAT_EQ(rules.material(0, 1).restitution, 0.5f);
  rules.set_material(1, 0, {0.01f, 0, 0, 0});
  EXPECT_FLOAT_EQ(rules.material(0, 1).thickness, 0.01f);
  EXPECT_FALSE(rules.meet(0, 0));
}

}  // namespace
}  // namespace pliant
