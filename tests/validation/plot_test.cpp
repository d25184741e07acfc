// Tests charts: ticks where a reader expects them, pixels of a curve where it is, and no crash whatever the data.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#include "apps/plot/chart.h"
#include "pliant/error.h"

namespace pliant::plot {
namespace {

bool is(const Canvas& canvas, int x, int y, Colour colour) {
  const std::size_t i =
      (static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas.width()) + static_cast<std::size_t>(x)) * 3;
  return canvas.pixels()[i] == colour.red && canvas.pixels()[i + 1] == colour.green &&
         canvas.pixels()[i + 2] == colour.blue;
}

TEST(Plot, TicksAreRoundNumbersWithinTheRange) {
  EXPECT_EQ(linear_ticks(-0.3, 10.2, 6).labels, (std::vector<std::string>{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(linear_ticks(0.0012, 0.0031, 4).labels, (std::vector<std::string>{"0.0015", "0.002", "0.0025", "0.003"}));
  EXPECT_EQ(logarithmic_ticks(0, 3, 7).labels, (std::vector<std::string>{"1", "10", "100", "1000"}));
  EXPECT_EQ(logarithmic_ticks(-4, 0, 7).labels, (std::vector<std::string>{"1e-4", "1e-3", "0.01", "0.1", "1"}));
  EXPECT_EQ(logarithmic_ticks(-0.1, 1.1, 7).labels, (std::vector<std::string>{"1", "2", "5", "10"}));
  EXPECT_EQ(logarithmic_ticks(std::log10(0.95), std::log10(1.5), 6).labels,
            (std::vector<std::string>{"1", "1.1", "1.2", "1.3", "1.4", "1.5"}))
      << "an axis with one mark says nothing";
  EXPECT_TRUE(linear_ticks(1, 1, 5).places.empty());
}

TEST(Plot, ALineCoversItsPixelsAndNoOthers) {
  Canvas canvas(40, 20, {255, 255, 255});
  canvas.line({5, 10}, {35, 10}, 4, {200, 0, 0});
  EXPECT_TRUE(is(canvas, 20, 10, {200, 0, 0}));
  EXPECT_TRUE(is(canvas, 20, 15, {255, 255, 255}));
  EXPECT_TRUE(is(canvas, 1, 10, {255, 255, 255}));
}

TEST(Plot, NothingIsPaintedOutsideTheClip) {
  Canvas canvas(40, 20, {255, 255, 255});
  canvas.clip({10, 5}, {20, 15});
  canvas.line({-1e9, 10}, {1e9, 10}, 30, {0, 0, 0});
  EXPECT_TRUE(is(canvas, 15, 10, {0, 0, 0}));
  EXPECT_TRUE(is(canvas, 30, 10, {255, 255, 255}));
  EXPECT_TRUE(is(canvas, 15, 2, {255, 255, 255}));
}

TEST(Plot, LettersLeaveInkAndOthersAreLeftOut) {
  Canvas canvas(200, 20, {255, 255, 255});
  canvas.text({2, 2}, "Pliant", 2, {0, 0, 0});
  EXPECT_NE(canvas.pixels(), Canvas(200, 20, {255, 255, 255}).pixels());
  EXPECT_EQ(Canvas::text_width("\xff\n", 2), 0);
}

/// A chart of constant curves at these heights.
Chart of_levels(const std::vector<double>& levels) {
  Chart chart;
  for (const double y : levels) chart.series.push_back({"", {0, 1}, {y, y}, Series::Style::line});
  return chart;
}

/// The first row in which a pixel has a colour; -1 if none has.
int first_row_of(const Canvas& canvas, Colour colour) {
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = 0; x < canvas.width(); ++x)
      if (is(canvas, x, y, colour)) return y;
  return -1;
}

TEST(Plot, TenCurvesHaveTenColours) {
  std::set<std::vector<std::uint8_t>> pictures;
  for (int colour = 0; colour < 10; ++colour) {
    Chart chart = of_levels({0});
    chart.series[0].colour = colour;
    pictures.insert(paint({chart}, 1, 400, 300).pixels());
  }
  EXPECT_EQ(pictures.size(), 10u);
}

TEST(Plot, AnAxisWithZeroShowsASmallDifferenceSmall) {
  constexpr Colour blue{0, 114, 178}, orange{213, 94, 0};
  Chart chart = of_levels({89.7, 89.9});
  const auto apart = [&] {
    const Canvas canvas = paint({chart}, 1, 400, 300);
    return first_row_of(canvas, blue) - first_row_of(canvas, orange);
  };
  EXPECT_GT(apart(), 100);
  chart.shows_zero = true;
  EXPECT_LT(apart(), 3);
}

TEST(Plot, ALongTitleOfTheYAxisStaysInItsChart) {
  Chart chart = of_levels({0, 1});
  chart.y_label = "a title that is longer than the axis which it is written beside";
  const Canvas canvas = paint({chart, of_levels({0, 1})}, 1, 400, 200);
  for (int y = 200; y < 400; ++y)
    for (int x = 0; x < 45; ++x) ASSERT_TRUE(is(canvas, x, y, {255, 255, 255})) << x << ' ' << y;
}

TEST(Plot, AnyDataMakesAPicture) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const std::vector<Chart> charts{
      {"empty", "", "", false, false, {}},
      {"one point", "", "", true, true, {{"a", {1}, {1}, Series::Style::points}}},
      {"constant", "", "", false, false, {{"a", {0, 1}, {0, 0}, Series::Style::dashed}}},
      {"gaps", "", "", true, true, {{"a", {-1, 0, nan, 1, 2}, {1, nan, infinity, -2, 3}, Series::Style::line}}},
      {"ragged", "", "", false, false, {{"a", {0, 1, 2}, {5}, Series::Style::line}}}};
  const Canvas canvas = paint(charts, 2, 320, 240);
  EXPECT_EQ(canvas.width(), 640);
  EXPECT_EQ(canvas.height(), 720);
}

/// The first columns of pixels, of which those with anything but paper are marked.
std::vector<bool> inked_columns(const Canvas& canvas, int columns) {
  std::vector<bool> inked;
  for (int x = 0; x < columns; ++x) {
    bool any = false;
    for (int y = 0; y < canvas.height(); ++y) any = any || !is(canvas, x, y, {255, 255, 255});
    inked.push_back(any);
  }
  return inked;
}

TEST(Plot, TheTitleOfAnAxisDoesNotTouchLongLabels) {
  for (const double unit : {1.0, 1e-3, 1e-4}) {
    Chart chart;
    chart.y_label = "a title";
    chart.series.push_back({});
    chart.series[0].x = {1, 2};
    chart.series[0].y = {0.0012 * unit, 0.0031 * unit};
    const std::vector<bool> inked = inked_columns(paint({chart}, 1, 700, 400), 200);
    const auto title = std::find(inked.begin(), inked.end(), true), gap = std::find(title, inked.end(), false),
               labels = std::find(gap, inked.end(), true);
    EXPECT_GE(gap - title, 10) << "the height of letters";
    EXPECT_GE(labels - gap, 6) << unit;
  }
}

TEST(Plot, APathThatCannotBeWrittenIsNamed) {
  try {
    write_png("/no/such/folder/chart.png", Canvas(4, 4, {}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/folder/chart.png"), std::string::npos);
  }
  EXPECT_THROW(Canvas(0, 4, {}), Error);
}

}  // namespace
}  // namespace pliant::plot
