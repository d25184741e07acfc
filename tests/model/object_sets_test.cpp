// Tests sets of objects that can meet: known answers, and a search over all pairs as the oracle.
#include "model/object_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace pliant {
namespace {

SetMember object(std::uint32_t groups, std::uint32_t mask, int substeps = 10) {
  return {groups, mask, true, false, substeps};
}

std::vector<int> most_of_sets(const std::vector<SetMember>& members) {
  std::vector<int> most;
  for (const SetSubsteps& set : substeps_of_sets(members)) most.push_back(set.substeps);
  return most;
}

TEST(ObjectSets, NobodyMeetsWhatDoesNotCollide) {
  SetMember loner = object(1, ~0u, 10);
  loner.collides = false;
  EXPECT_EQ(find_sets({loner, object(1, ~0u), loner, object(1, ~0u)}), (std::vector<int>{0, 1, 2, 1}));
  EXPECT_EQ(most_of_sets({loner, object(1, ~0u, 20), object(1, ~0u, 10)}), (std::vector<int>{10, 20, 20}));
}

TEST(ObjectSets, CollidersJoinObjectsAndNoOtherCollider) {
  SetMember loner = object(2, 1), other = object(4, 8);
  loner.collides = other.collides = false;
  const SetMember mesh{1, ~0u, false, true, 0}, far{8, 4, false, true, 0};
  EXPECT_EQ(find_sets({mesh, far}), (std::vector<int>{0, 1}));
  EXPECT_EQ(find_sets({mesh, far, loner, other}), (std::vector<int>{0, 1, 0, 1}));
}

TEST(ObjectSets, AreTheConnectedPartsOfAllPairs) {
  std::mt19937 random(7);
  int several = 0;
  for (int round = 0; round < 500; ++round) {
    std::vector<SetMember> members;
    const int count = 1 + static_cast<int>(random() % 12);
    for (int i = 0; i < count; ++i) {
      const bool is_collider = random() % 4 == 0;
      members.push_back({std::uint32_t(random() % 16), std::uint32_t(random() % 16), !is_collider && random() % 3 != 0,
                         is_collider, is_collider ? 0 : 10 + 10 * static_cast<int>(random() % 2)});
    }
    const auto meet = [&](const SetMember& a, const SetMember& b) {
      if ((a.groups & b.mask) == 0 || (b.groups & a.mask) == 0 || (a.is_collider && b.is_collider)) return false;
      return a.is_collider || b.is_collider || (a.collides && b.collides);
    };
    std::vector<int> sets(members.size());
    for (int i = 0; i < count; ++i) sets[i] = i;
    for (int pass = 0; pass < count; ++pass)
      for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
          if (i != j && meet(members[i], members[j])) sets[i] = sets[j] = std::min(sets[i], sets[j]);
    ASSERT_EQ(find_sets(members), sets);
    std::vector<int> most(members.size(), 0);
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j)
        if (sets[i] == sets[j]) most[i] = std::max(most[i], members[j].substeps);
    ASSERT_EQ(most_of_sets(members), most);
    several += std::count(sets.begin(), sets.end(), 0) < count ? 1 : 0;
  }
  EXPECT_GT(several, 100);
}

/// One that follows the State makes its set do so, unless another needs a fixed number.
TEST(ObjectSets, FollowTheStateUnlessOneIsFixed) {
  SetMember any = object(1, ~0u, 20), by_state = object(1, ~0u, 20), fixed = object(1, ~0u, 20);
  by_state.rule = SubstepRule::by_state;
  fixed.rule = SubstepRule::fixed;
  any.substeps = 15;
  EXPECT_FALSE(substeps_of_sets({any, any})[0].by_state);
  EXPECT_TRUE(substeps_of_sets({any, by_state})[0].by_state);
  EXPECT_EQ(substeps_of_sets({any, by_state})[0].least, 15);
  EXPECT_EQ(substeps_of_sets({by_state, by_state})[1].least, 0);
  EXPECT_FALSE(substeps_of_sets({any, by_state, fixed})[2].by_state);
}

/// A rope of `points` particles, a gram each and 0.1 m apart, whose bending is soft springs across two links.
Object rope(int points, float link_compliance) {
  Object out;
  ConstraintGroup links, struts;
  links.type = struts.type = "distance";
  links.stiffness = Stiffness::compliance(link_compliance);
  struts.stiffness = Stiffness::compliance(0.01f);
  for (int i = 0; i < points; ++i) {
    out.positions.push_back({0.1f * static_cast<float>(i), 0, 0});
    out.masses.push_back(0.001f);
    if (i > 0) links.particles.insert(links.particles.end(), {i - 1, i});
    if (i > 1) struts.particles.insert(struts.particles.end(), {i - 2, i});
  }
  out.constraints = {struts, links};
  return out;
}

/// 60 grams on links of compliance 1e-4 m/N: 0.1 * 1e-3 * 9.81 * 6 = 5.9e-4.
TEST(ObjectSets, LeaveOutWhatBendsARope) {
  constexpr double gravity = 9.81;
  EXPECT_NEAR(*strain_by_weight(rope(60, 1e-4f), gravity), 5.9e-4, 1e-5);
  EXPECT_FALSE(is_meant_to_stretch(rope(60, 1e-4f), gravity));
  EXPECT_TRUE(is_meant_to_stretch(rope(60, 1e-3f), gravity));
  EXPECT_EQ(substep_rule(rope(60, 0), Sweep::chains, gravity), SubstepRule::by_state);
  EXPECT_EQ(substep_rule(rope(60, 1e-3f), Sweep::chains, gravity), SubstepRule::any);
  EXPECT_EQ(substep_rule(rope(40, 0), Sweep::chains, gravity), SubstepRule::by_state);
  EXPECT_EQ(substep_rule(rope(60, 0), Sweep::tiled, gravity), SubstepRule::any);
  Object touching = rope(40, 0);
  touching.self_collision = true;
  EXPECT_EQ(substep_rule(touching, Sweep::chains, gravity), SubstepRule::by_state);
}

}  // namespace
}  // namespace pliant
