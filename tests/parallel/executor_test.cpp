// Tests the parallel loop: every index once, on any number of threads, inside and outside enter(); and its timings.
#include "parallel/executor.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

namespace pliant {
namespace {

TEST(Executor, VisitsEveryIndexOnce) {
  for (int threads : {1, 2, 3, 8}) {
    Executor executor(threads);
    EXPECT_EQ(executor.threads(), threads);
    for (int n : {0, 1, 2, 17, 1000}) {
      std::vector<std::atomic<int>> visits(static_cast<std::size_t>(n));
      executor.enter(
          [&] { executor.parallel_for("visits", n, [&](int i) { ++visits[static_cast<std::size_t>(i)]; }); });
      executor.parallel_for("visits", n, [&](int i) { ++visits[static_cast<std::size_t>(i)]; });
      for (const auto& count : visits) EXPECT_EQ(count, 2);
    }
  }
}

TEST(Executor, TakesAllThreadsUnlessTold) { EXPECT_GE(Executor(0).threads(), 1); }

TEST(Executor, SumsInSlotsAreTheSameOnAnyNumberOfThreads) {
  const auto sum_with = [](int threads) {
    Executor executor(threads);
    std::vector<float> parts(64);
    executor.enter([&] {
      executor.parallel_for("sum", 64, [&](int part) {
        float sum = 0;
        for (int i = 0; i < 1000; ++i) sum += 1.f / static_cast<float>(1 + part * 1000 + i);
        parts[static_cast<std::size_t>(part)] = sum;
      });
    });
    float sum = 0;
    for (float part : parts) sum += part;
    return sum;
  };
  for (int threads : {2, 3, 4, 8}) EXPECT_EQ(sum_with(threads), sum_with(1));
}

/// Bodies that run at the same time have different scratch memory, though their inner loops share threads.
TEST(Executor, RunsLoopsSideBySide) {
  for (const int threads : {1, 2, 3, 8}) {
    Executor executor(threads);
    std::vector<std::atomic<int>> users(static_cast<std::size_t>(threads)), visits(50);
    std::atomic<int> shared{0};
    executor.enter([&] {
      executor.side_by_side(50, [&](int i, int thread) {
        ASSERT_GE(thread, 0);
        ASSERT_LT(thread, threads);
        std::atomic<int>& user = users[static_cast<std::size_t>(thread)];
        if (++user > 1) ++shared;
        for (int loop = 0; loop < 5; ++loop)
          executor.parallel_for("inner", 20, [&](int) {
            ++visits[static_cast<std::size_t>(i)];
            std::this_thread::sleep_for(std::chrono::microseconds(20));  // so that others wait for the loop's end
          });
        --user;
      });
    });
    EXPECT_EQ(shared, 0);
    for (const auto& count : visits) EXPECT_EQ(count, 100);
    ASSERT_EQ(executor.timings().entries().size(), 1U);
    EXPECT_GT(executor.timings().entries()[0].milliseconds, 0);
  }
}

TEST(Executor, ForgetsLoopsSideBySideThatAnExceptionEnds) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    auto executor = std::make_unique<Executor>(3);
    const auto fail = [&] {
      executor->enter([&] {
        executor->side_by_side(8, [&](int i, int) {
          executor->parallel_for("inner", 20, [](int) {});
          if (i == 3) throw std::runtime_error("of the user");
        });
      });
    };
    EXPECT_THROW(fail(), std::runtime_error);
    executor.reset();
    Executor next(3);  // times its loops on threads that ended with the exception
    next.enter([&] { next.parallel_for("next", 50, [](int) {}); });
    ASSERT_EQ(next.timings().entries().size(), 1U);
  }
}

TEST(Executor, CanBeMoved) {
  Executor first(3);
  Executor second(std::move(first));
  std::atomic<int> visits{0};
  second.enter([&] { second.parallel_for("visits", 100, [&](int) { ++visits; }); });
  EXPECT_EQ(visits, 100);
  first = std::move(second);
  EXPECT_EQ(first.threads(), 3);
}

TEST(Timings, AddUpUnderTheirNames) {
  Timings timings;
  char copy[] = "solve";  // another pointer to the same name
  timings.add("solve", 1);
  timings.add("predict", 10);
  timings.add(copy, 2);
  ASSERT_EQ(timings.entries().size(), 2u);
  EXPECT_STREQ(timings.entries()[0].name, "solve");
  EXPECT_EQ(timings.entries()[0].milliseconds, 3);
  EXPECT_EQ(timings.entries()[1].milliseconds, 10);
  timings.clear();
  EXPECT_EQ(timings.entries()[0].milliseconds, 0);
}

TEST(Executor, OfMoreThreadsBesideOthersComplainsNowhere) {
  const int usual = Executor(0).threads();
  testing::internal::CaptureStderr();
  Executor few(2), many(64);
  for (Executor* executor : {&few, &many, &few}) {
    std::atomic<int> sum{0};
    executor->enter([&] { executor->parallel_for("loop", 1000, [&](int i) { sum += i; }); });
    EXPECT_EQ(sum, 499500);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(Executor(0).threads(), usual) << "what one asks for is nothing to those that ask for nothing";
}

TEST(Timings, EveryLoopTimesItself) {
  Executor executor(2);
  const auto wait = [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(3)); };
  executor.parallel_for("first", 1, wait);
  executor.parallel_for("second", 1, [](int) {});
  executor.parallel_for("first", 1, wait);
  const auto& entries = executor.timings().entries();
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(std::strcmp(entries[0].name, "first"), 0);
  EXPECT_GE(entries[0].milliseconds, 6) << "the sum of both";
  EXPECT_EQ(std::strcmp(entries[1].name, "second"), 0);
}

}  // namespace
}  // namespace pliant
