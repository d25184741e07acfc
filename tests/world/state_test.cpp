// Tests that a State is a value: a restored one continues with the same bits, and its hash depends on all of it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pliant/error.h"
#include "support/nonfinite.h"
#include "support/refusal.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

// ------------------------------------------------------------------------------------------------ snapshots

TEST(Snapshot, ResumesInTheSameBits) {
  World world(hanging_cloth());
  for (int frame = 0; frame < 10; ++frame) world.step(dt);
  const State middle = world.state();
  std::vector<std::string> hashes;
  for (int frame = 0; frame < 10; ++frame) {
    world.step(dt);
    hashes.push_back(world.state_hash());
  }
  world.restore(middle);
  EXPECT_EQ(world.state_hash(), hash(middle));
  for (const std::string& expected : hashes) {
    world.step(dt);
    EXPECT_EQ(world.state_hash(), expected);
  }
  World another(hanging_cloth());
  another.restore(middle);
  for (const std::string& expected : hashes) {
    another.step(dt);
    EXPECT_EQ(another.state_hash(), expected) << "in a new World";
  }
}

TEST(Snapshot, OfAnotherWorldOrSpoiltIsRefused) {
  World world(hanging_cloth());
  world.step(dt);
  const std::string before = world.state_hash();
  const auto refused = [&](const auto& spoil) {
    State state = world.state();
    spoil(state);
    try {
      world.restore(state);
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused([](State& s) { s.positions.pop_back(); }));
  EXPECT_TRUE(refused([](State& s) { s.velocities.pop_back(); }));
  EXPECT_TRUE(refused([](State& s) { s.remainders.clear(); }));
  EXPECT_TRUE(refused([](State& s) { s.positions.resize(1000); }));
  EXPECT_TRUE(refused([](State& s) { s.positions[3].x = nan; }));
  EXPECT_TRUE(refused([](State& s) { s.velocities[3].y = infinity; }));
  EXPECT_TRUE(refused([](State& s) { s.remainders[3].z = nan; }));
  EXPECT_TRUE(refused([](State& s) { s.positions[3].w = 77; }));
  EXPECT_TRUE(refused([](State& s) { s.positions[3].w = nan; }));
  EXPECT_TRUE(refused([](State& s) { s.velocities[3].w = 1; })) << "it would change the mass";
  EXPECT_TRUE(refused([](State& s) { s.remainders[3].w = 1; })) << "it would change the mass";
  EXPECT_TRUE(refused([](State& s) { s.time = std::numeric_limits<double>::infinity(); }));
  EXPECT_TRUE(refused([](State& s) { s.frame = -1; }));
  EXPECT_TRUE(refused([](State& s) { s.frame = std::numeric_limits<std::int64_t>::max(); })) << "it could not count on";
  EXPECT_EQ(world.state_hash(), before) << "and nothing has changed";
  EXPECT_FALSE(refused([](State&) {}));
}

TEST(Snapshot, OfAnotherWorldIsRefusedInWords) {
  World world(hanging_cloth());
  State other = world.state();
  other.blocks[0].generation = 1;
  EXPECT_EQ(
      refusal([&] { world.restore(other); }),
      "object 'cloth': the state is of a World with other objects, or from before one was added, removed or edited; "
      "restore a state that was taken since the last such change");
  State held = world.state();
  held.held_poses.push_back({false, 7, 0, {}, {}});
  EXPECT_EQ(refusal([&] { world.restore(held); }),
            "the state holds a pose of a collider that this World does not have; restore a state of this world");
}

TEST(Snapshot, ReadsTheSameInAnyWorld) {
  Scene scene = hanging_cloth();
  scene.settings.record_multipliers = true;
  ClothOptions options;
  options.volume = Volume{2, Stiffness::compliance(1e-3f)};
  scene.add_cloth(sphere_mesh(1), options);
  World world(scene), fresh(scene);
  for (int frame = 0; frame < 10; ++frame) world.step(dt);
  const State state = world.state();
  for (World* each : {&world, &fresh}) each->restore(state);
  const std::vector<Residual> expected = world.measure().residuals(), found = fresh.measure().residuals();
  ASSERT_EQ(expected.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].rms, expected[i].rms) << found[i].type;
  EXPECT_EQ(world.object(0).multipliers("distance"), fresh.object(0).multipliers("distance"));
  EXPECT_EQ(world.object(1).multipliers("volume"), fresh.object(1).multipliers("volume"));
}

TEST(Hash, SeesEveryMemberAndEveryBit) {
  World world(hanging_cloth());
  world.step(dt);
  const State state = world.state();
  const std::string original = hash(state);
  EXPECT_EQ(original.size(), 64u);
  const auto changed = [&](const auto& change) {
    State copy = state;
    change(copy);
    return hash(copy) != original;
  };
  EXPECT_TRUE(changed([](State& s) { s.time += 1e-9; }));
  EXPECT_TRUE(changed([](State& s) { ++s.frame; }));
  EXPECT_TRUE(changed([](State& s) { s.positions.back().z = std::nextafter(s.positions.back().z, 9.f); }));
  EXPECT_TRUE(changed([](State& s) { s.remainders[5].x += 1e-12f; }));
  EXPECT_TRUE(changed([](State& s) { s.velocities[0].y = -s.velocities[0].y - 1e-30f; }));
  EXPECT_FALSE(changed([](State&) {}));
}

}  // namespace
}  // namespace pliant
