// The pairs of thread count and instruction set by which tests run what must have one hash.
//
// A scene runs by 1, 2, 3 and 8 threads and by each level once, not by all of their products: a fault of a level or
// of a thread count shows in its pair. Only where a pair differs do all products run, to tell which of the two it is.
// With PLIANT_THOROUGH=1 all products run at once, those of the best level three times, since threads may give other
// bits only sometimes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "pliant/pliant.h"
#include "support/kernels.h"

namespace pliant::testing_support {

struct WayToRun {
  int threads;
  std::string isa;  ///< empty: the best that this machine runs
};

inline constexpr int thread_counts[] = {1, 2, 3, 4, 8};

/// Pairs, with a level where the build holds it and this machine runs it; or all products.
inline std::vector<WayToRun> ways_to_run() {
  const std::vector<std::string> available = available_isas();
  std::vector<WayToRun> ways{{1, "x86-64-v4"}, {8, "generic"}, {3, "x86-64-v2"}, {2, "x86-64-v3"}};
  if (std::getenv("PLIANT_THOROUGH") != nullptr) {
    ways.clear();
    for (const std::string& isa : available)
      for (const int threads : thread_counts) ways.push_back({threads, isa});
    for (const int threads : thread_counts) ways.insert(ways.end(), 2, {threads, available.back()});
  }
  for (WayToRun& way : ways)
    if (std::find(available.begin(), available.end(), way.isa) == available.end()) way.isa.clear();
  return ways;
}

/// Names the thread counts and levels whose hash is another: run(threads, isa) for all of their products.
template <class Run>
std::string differing_ways(const std::string& expected, const Run& run) {
  std::string text;
  for (const std::string& isa : available_isas())
    for (const int threads : thread_counts)
      text +=
          "\n  " + std::to_string(threads) + " x " + isa + (run(threads, isa) == expected ? ": same" : ": DIFFERENT");
  return text;
}

/// Expects the hash of run(threads, isa) by each of these ways.
template <class Run>
void expect_hash(const std::string& expected, const Run& run, const std::vector<WayToRun>& ways) {
  for (const WayToRun& way : ways) {
    const std::string hash = run(way.threads, way.isa);
    if (hash == expected) continue;
    ADD_FAILURE() << way.threads << " threads, " << (way.isa.empty() ? "best level" : way.isa) << ": " << hash
                  << " instead of " << expected << "; all products run next";
    FAIL() << "run by all:" << differing_ways(expected, run);
  }
}

}  // namespace pliant::testing_support
