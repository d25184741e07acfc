// Tests loops over ranges: every item once, on any number of threads, in ranges of the given length but the last one.
#include "parallel/ranges.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace pliant {
namespace {

TEST(Ranges, CountsThemForAsManyItemsAsThereCanBe) {
  EXPECT_EQ(ranges_of(0, 4), 0);
  EXPECT_EQ(ranges_of(1, 4), 1);
  EXPECT_EQ(ranges_of(4, 4), 1);
  EXPECT_EQ(ranges_of(5, 4), 2);
  EXPECT_EQ(ranges_of(std::numeric_limits<int>::max(), 1024), 2097152);
}

TEST(Ranges, HaveTheGivenLengthButTheLastOne) {
  for (const int threads : {1, 3}) {
    Executor executor(threads);
    std::vector<std::pair<int, int>> found(3);
    for_ranges(executor, nullptr, 10, 4, [&](int first, int last) {
      found[static_cast<std::size_t>(first / 4)] = {first, last};
    });
    EXPECT_EQ(found, (std::vector<std::pair<int, int>>{{0, 4}, {4, 8}, {8, 10}}));
  }
}

TEST(Ranges, VisitEveryItemOnce) {
  for (const int threads : {1, 2, 8}) {
    Executor executor(threads);
    for (const int count : {0, 1, 15, 16, 17, 100}) {
      std::vector<int> visits(static_cast<std::size_t>(count) + 1, 0);
      for_items(executor, nullptr, count, 16, [&](int i) { ++visits[static_cast<std::size_t>(i)]; });
      for (int i = 0; i < count; ++i) ASSERT_EQ(visits[static_cast<std::size_t>(i)], 1) << i << " of " << count;
      EXPECT_EQ(visits.back(), 0) << "beyond the last of " << count;
    }
  }
}

TEST(Ranges, AreTimedUnderTheirName) {
  Executor executor(1);
  for_items(executor, "items", 3, 2, [](int) {});
  ASSERT_EQ(executor.timings().entries().size(), 1u);
  EXPECT_STREQ(executor.timings().entries()[0].name, "items");
}

}  // namespace
}  // namespace pliant
