// Tests launch: every item once, on any number of threads, in blocks that cover all items.
#include "parallel/launch.h"

#include <gtest/gtest.h>

#include <vector>

#include "pliant/vec3.h"

namespace pliant {
namespace {

struct Count {
  int* visits;
  PLIANT_HD void operator()(int i) const { ++visits[i]; }
};

TEST(Launch, VisitsEveryItemOnce) {
  for (const int threads : {1, 2, 8}) {
    Executor executor(threads);
    for (const int n : {0, 1, launch_block - 1, launch_block, launch_block + 1, 5 * launch_block + 7}) {
      std::vector<int> visits(static_cast<std::size_t>(n) + 1, 0);
      launch(executor, "count", n, Count{visits.data()});
      for (int i = 0; i < n; ++i) ASSERT_EQ(visits[static_cast<std::size_t>(i)], 1) << i << " of " << n;
      EXPECT_EQ(visits.back(), 0) << "beyond the last of " << n;
    }
  }
}

TEST(Launch, BlocksMakeUpTheWholeInAnyOrder) {
  const int n = 3 * launch_block + 5;
  std::vector<int> visits(static_cast<std::size_t>(n), 0);
  for (int block = launch_blocks(n) - 1; block >= 0; --block) run_block(Count{visits.data()}, block, n);
  for (const int count : visits) EXPECT_EQ(count, 1);
}

TEST(Launch, CountsBlocksOfAsManyItemsAsThereCanBe) {
  EXPECT_EQ(launch_blocks(0), 0);
  EXPECT_EQ(launch_blocks(2147483647), 2097152);
}

TEST(Launch, TimesItselfUnderItsName) {
  Executor executor(1);
  int visits = 0;
  launch(executor, "one", 1, Count{&visits});
  ASSERT_EQ(executor.timings().entries().size(), 1u);
  EXPECT_STREQ(executor.timings().entries()[0].name, "one");
}

}  // namespace
}  // namespace pliant
