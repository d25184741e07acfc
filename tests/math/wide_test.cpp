// Compares every operation of Wide with that of plain floats, lane by lane, and tests loading and storing records.
#include "math/wide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "math/functions.h"
#include "support/bits.h"

namespace pliant {
namespace {

using testing_support::nasty_float;
using testing_support::same_bits;

using Lanes = std::array<float, wide_width>;

Lanes lanes_of(const Wide& a) {
  Lanes lanes;
  store_wide(lanes.data(), a);
  return lanes;
}
Lanes nasty_lanes(std::mt19937& random) {
  Lanes lanes;
  for (float& lane : lanes) lane = nasty_float(random);
  return lanes;
}

/// Compares f of two Wides with f of the floats in their lanes, for many numbers.
template <class F>
void expect_lanewise(const char* name, const F& f) {
  std::mt19937 random(1);
  for (int round = 0; round < 6000; ++round) {
    const Lanes a = nasty_lanes(random), b = nasty_lanes(random);
    const Lanes wide = lanes_of(f(load_wide(a.data()), load_wide(b.data())));
    for (std::size_t lane = 0; lane < wide.size(); ++lane) {
      const float alone = f(a[lane], b[lane]);
      ASSERT_TRUE(same_bits(wide[lane], alone))
          << name << " of " << a[lane] << " and " << b[lane] << ": " << wide[lane] << ", not " << alone;
    }
  }
}

TEST(Wide, ArithmeticIsThatOfFloats) {
  expect_lanewise("+", [](const auto& a, const auto& b) { return a + b; });
  expect_lanewise("-", [](const auto& a, const auto& b) { return a - b; });
  expect_lanewise("*", [](const auto& a, const auto& b) { return a * b; });
  expect_lanewise("/", [](const auto& a, const auto& b) { return a / b; });
  expect_lanewise("negation", [](const auto& a, const auto&) { return -a; });
  expect_lanewise("sum and product, not fused", [](const auto& a, const auto& b) { return a * b + a; });
}

TEST(Wide, FunctionsAreThoseOfFloats) {
  expect_lanewise("sqrt", [](const auto& a, const auto&) { return sqrt(a); });
  expect_lanewise("abs", [](const auto& a, const auto&) { return abs(a); });
  expect_lanewise("min", [](const auto& a, const auto& b) { return min(a, b); });
  expect_lanewise("max", [](const auto& a, const auto& b) { return max(a, b); });
  expect_lanewise("clamp", [](const auto& a, const auto& b) { return clamp(a, -b, b); });
  expect_lanewise("atan2", [](const auto& a, const auto& b) { return atan2(a, b); });
  expect_lanewise("acos", [](const auto& a, const auto&) { return acos(a); });
}

TEST(Wide, ComparisonsChooseLaneByLane) {
  expect_lanewise("<", [](const auto& a, const auto& b) { return select(a < b, a, b); });
  expect_lanewise(">", [](const auto& a, const auto& b) { return select(a > b, a, b); });
  expect_lanewise("<=", [](const auto& a, const auto& b) { return select(a <= b, a, b); });
  expect_lanewise(">=", [](const auto& a, const auto& b) { return select(a >= b, a, b); });
  expect_lanewise("==", [](const auto& a, const auto& b) { return select(a == b, b * b, a); });
}

TEST(Wide, ValueIsInEveryLane) {
  for (float value : {0.f, -0.f, 1e-45f, 2.5f, 3e38f}) {
    for (float lane : lanes_of(Wide(value))) EXPECT_EQ(lane, value);
  }
}

std::vector<Record> numbered_records(int count) {
  std::vector<Record> records(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const float n = static_cast<float>(4 * i);
    records[static_cast<std::size_t>(i)] = {n, n + 1, n + 2, n + 3};
  }
  return records;
}

void expect_records(const WideRecords& wide, const std::array<int, wide_width>& at) {
  const Lanes x = lanes_of(wide.position.x), y = lanes_of(wide.position.y), z = lanes_of(wide.position.z),
              w = lanes_of(wide.w);
  for (std::size_t lane = 0; lane < at.size(); ++lane) {
    const float n = static_cast<float>(4 * at[lane]);
    EXPECT_EQ(x[lane], n);
    EXPECT_EQ(y[lane], n + 1);
    EXPECT_EQ(z[lane], n + 2);
    EXPECT_EQ(w[lane], n + 3);
  }
}

/// Adds a thousand to every number.
WideRecords raised(WideRecords r) {
  const Wide thousand(1000.f);
  return {{r.position.x + thousand, r.position.y + thousand, r.position.z + thousand}, r.w + thousand};
}

bool is_raised(const std::vector<Record>& records, int i) {
  const float n = static_cast<float>(4 * i);
  const Record& r = records[static_cast<std::size_t>(i)];
  const bool all = r.x == n + 1000 && r.y == n + 1001 && r.z == n + 1002 && r.w == n + 1003;
  EXPECT_TRUE(all || (r.x == n && r.y == n + 1 && r.z == n + 2 && r.w == n + 3)) << "record " << i << " is torn";
  return all;
}

TEST(WideRecordsByIndex, GoInAndOutWholeOrInPart) {
  std::array<int, wide_width> index{17, 3, 9, 40, 0, 1, 2, 39, 20, 33, 21, 5, 30, 12, 8, 25};
  for (int lanes = 1; lanes <= wide_width + 1; ++lanes) {  // one more: the whole store
    std::vector<Record> records = numbered_records(41);
    const WideRecords wide = from_registers(load_indexed(records.data(), index.data()));
    expect_records(wide, index);
    if (lanes <= wide_width) {
      store_indexed_some(records.data(), index.data(), to_registers(raised(wide)), lanes);
    } else {
      store_indexed(records.data(), index.data(), to_registers(raised(wide)));
    }
    for (int i = 0; i < 41; ++i) {
      const auto found = std::find(index.begin(), index.end(), i);
      EXPECT_EQ(is_raised(records, i), found - index.begin() < std::min(lanes, wide_width))
          << "record " << i << ", " << lanes << " lanes";
    }
  }
}

TEST(WideRecordsByRun, GoInAndOutWholeOrInPart) {
  const std::array<int, 4> run{8, 0, 33, 20};
  std::array<int, wide_width> at;
  for (std::size_t lane = 0; lane < at.size(); ++lane) at[lane] = run[lane % 4] + static_cast<int>(lane / 4);
  for (int runs = 1; runs <= 4; ++runs) {
    std::vector<Record> records = numbered_records(40);
    const WideRecords wide = from_registers(load_runs(records.data(), run.data()));
    expect_records(wide, at);
    store_runs(records.data(), run.data(), to_registers(raised(wide)), runs);
    for (int i = 0; i < 40; ++i) {
      bool expected = false;
      for (int j = 0; j < runs; ++j) {
        const int first = run[static_cast<std::size_t>(j)];
        expected = expected || (i >= first && i < first + 4);
      }
      EXPECT_EQ(is_raised(records, i), expected) << "record " << i << ", " << runs << " runs";
    }
  }
}

TEST(WideRecordsInRegisters, AddAndPartLaneByLane) {
  const std::vector<Record> records = numbered_records(40);
  const std::array<int, 4> run{8, 0, 33, 20};
  const Registers all = load_runs(records.data(), run.data());
  const WideRecords there = from_registers(without_w(all)), twice = from_registers(all + all),
                    apart = from_registers(minus_xyz(all + all, all));
  const Wide mass = w_of(all);
  const WideRecords nothing = from_registers(all - all);
  for (std::size_t lane = 0; lane < wide_width; ++lane) {
    const float n = static_cast<float>(4 * (run[lane % 4] + static_cast<int>(lane / 4)));
    EXPECT_EQ(lanes_of(there.position.z)[lane], n + 2);
    EXPECT_EQ(lanes_of(there.w)[lane], 0);
    EXPECT_EQ(lanes_of(mass)[lane], n + 3);
    EXPECT_EQ(lanes_of(apart.position.x)[lane], n);
    EXPECT_EQ(lanes_of(apart.position.y)[lane], n + 1);
    EXPECT_EQ(lanes_of(apart.position.z)[lane], n + 2);
    EXPECT_EQ(lanes_of(apart.w)[lane], 2 * (n + 3));
    EXPECT_EQ(lanes_of(twice.position.y)[lane], 2 * (n + 1));
    EXPECT_EQ(lanes_of(nothing.w)[lane], 0);
  }
}

}  // namespace
}  // namespace pliant
