// Tests the verdicts of rows: what passes, what fails, and that NaN never passes.
#include "apps/validate/rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pliant/error.h"

namespace pliant::validate {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

TEST(Rows, RelativeToleranceIsAShareOfTheExpectedValue) {
  EXPECT_TRUE(relative("", 200, 201.9, 0.01, "").pass);
  EXPECT_FALSE(relative("", 200, 202.1, 0.01, "").pass);
  EXPECT_TRUE(relative("", -200, -198.1, 0.01, "").pass);
}

TEST(Rows, AbsoluteToleranceIsNot) {
  EXPECT_TRUE(absolute("", 0, 0.009, 0.01, "").pass);
  EXPECT_FALSE(absolute("", 0, -0.011, 0.01, "").pass);
}

TEST(Rows, BoundsHaveNoTolerance) {
  EXPECT_TRUE(at_most("", 20, 20, "").pass);
  EXPECT_FALSE(at_most("", 20, std::nextafter(20, 21), "").pass);
  EXPECT_TRUE(at_least("", 20, 20, "").pass);
  EXPECT_FALSE(at_least("", 20, std::nextafter(20, 19), "").pass);
}

TEST(Rows, WhatIsNotFiniteFails) {
  for (double value : {nan, infinity}) {
    EXPECT_FALSE(relative("", 1, value, 0.5, "").pass);
    EXPECT_FALSE(absolute("", 1, value, 0.5, "").pass);
    EXPECT_FALSE(at_most("", 1, value, "").pass);
    EXPECT_FALSE(at_least("", 1, value, "").pass);
  }
}

TEST(Rows, TheFarthestIsFoundOnEitherSide) {
  EXPECT_EQ(farthest(1, {1.1, 0.8, 1.05}), 0.8);
  EXPECT_EQ(farthest(1, {}), 1);
  EXPECT_TRUE(std::isnan(farthest(1, {1, nan, 5})));
}

TEST(Rows, AnUnknownGroupIsRefusedByName) {
  Options options;
  options.name = "perpetual motion";
  try {
    run_validation(options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("perpetual motion"), std::string::npos);
    EXPECT_NE(error.advice().find("spring"), std::string::npos);
  }
}

TEST(Rows, TheTableHasALineARowAndItsVerdict) {
  const std::string table = to_table({relative("a", 1, 1, 0, "m"), at_most("b", 1, 2, "s", "why")});
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
  EXPECT_NE(table.find("pass"), std::string::npos);
  EXPECT_NE(table.find("FAIL"), std::string::npos);
  EXPECT_NE(table.find("<= 1"), std::string::npos);
}

TEST(Rows, JsonHoldsNoNumberThatJsonHasNot) {
  const std::string json = to_json({relative("a", 1, nan, 0, "m")});
  EXPECT_EQ(json.find("nan"), std::string::npos);
  EXPECT_NE(json.find("\"measured\": null"), std::string::npos);
}

}  // namespace
}  // namespace pliant::validate
