// Tests the blocks of a State: they do not overlap, holes are used again, and the end decreases when the last block is
// removed.
#include "model/blocks.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

namespace pliant {
namespace {

TEST(Blocks, FollowOneAnother) {
  BlockAllocator blocks;
  EXPECT_EQ(blocks.allocate(10, 0), 0);
  EXPECT_EQ(blocks.allocate(5, 1), 10);
  EXPECT_EQ(blocks.end(), 15);
  EXPECT_EQ(blocks.owner_of(9), 0);
  EXPECT_EQ(blocks.owner_of(10), 1);
}

TEST(Blocks, HolesAreUsedAgainAndJoin) {
  BlockAllocator blocks;
  for (int i = 0; i < 4; ++i) blocks.allocate(10, i);
  blocks.release(10, 10);
  EXPECT_EQ(blocks.allocate(11, 4), 40) << "it does not fit the hole";
  EXPECT_EQ(blocks.allocate(4, 5), 10);
  EXPECT_EQ(blocks.allocate(6, 6), 14);
  blocks.release(10, 4);
  blocks.release(20, 10);
  blocks.release(14, 6);
  EXPECT_EQ(blocks.allocate(20, 7), 10) << "three holes next to one another are one";
  blocks.release(40, 11);
  EXPECT_EQ(blocks.end(), 40);
  blocks.release(10, 20);
  blocks.release(30, 10);
  EXPECT_EQ(blocks.end(), 10) << "a hole at the end is none";
}

TEST(Blocks, NeverOverlapAndStayCompact) {
  std::mt19937 random(7);
  BlockAllocator blocks;
  std::map<int, int> held;  // size by owner
  std::map<int, int> first;
  int live = 0, most_live = 0, most_end = 0;
  for (int round = 0; round < 20000; ++round) {
    const int owner = static_cast<int>(random() % 100);
    if (held.count(owner) != 0) {
      blocks.release(first[owner], held[owner]);
      live -= held[owner];
      held.erase(owner);
    } else {
      const int size = 1 + static_cast<int>(random() % 50);
      first[owner] = blocks.allocate(size, owner);
      held[owner] = size;
      live += size;
    }
    most_live = std::max(most_live, live);
    most_end = std::max(most_end, blocks.end());
    if (round % 100 != 0) continue;
    std::vector<int> owner_at(static_cast<std::size_t>(blocks.end()), -1);
    for (const auto& [who, size] : held) {
      for (int i = first[who]; i < first[who] + size; ++i) {
        ASSERT_LT(i, blocks.end());
        ASSERT_EQ(owner_at[static_cast<std::size_t>(i)], -1);
        owner_at[static_cast<std::size_t>(i)] = who;
        ASSERT_EQ(blocks.owner_of(i), who);
      }
    }
  }
  EXPECT_LT(most_end, 2 * most_live);
}

}  // namespace
}  // namespace pliant
