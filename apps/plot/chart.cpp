// Paints charts: finds the ranges, then draws axes, ticks, curves and legend.
#include "apps/plot/chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>

namespace pliant::plot {
namespace {

constexpr Colour paper{255, 255, 255}, ink{38, 42, 48}, faint{228, 231, 235}, frame{150, 156, 164};
constexpr double title_size = 2, text_size = 2, font_height = 7;
constexpr double least_left_margin = 104, right_margin = 26, title_height = 44, legend_line = 22, legend_stroke = 34;

// The title of the y-axis lies between these distances from the edge of the chart; tick labels end before the axis.
constexpr double title_left = 16, title_right = title_left + 12 * text_size, label_distance = 11;

// Colours that can be told apart with any colour vision (Okabe and Ito 2008).
constexpr Colour palette[] = {{0, 114, 178},  {213, 94, 0},    {0, 158, 115}, {204, 121, 167}, {230, 159, 0},
                              {86, 180, 233}, {110, 110, 110}, {0, 0, 0},     {150, 156, 164}, {136, 34, 85}};

Colour colour_of(const Chart& chart, std::size_t series) {
  const int chosen = chart.series[series].colour;
  return palette[(chosen < 0 ? series : static_cast<std::size_t>(chosen)) % std::size(palette)];
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// A value on an axis, or its logarithm on a logarithmic axis.
double even(double value, bool logarithmic) {
  if (!logarithmic) return value;
  return value > 0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// A number on a logarithmic axis: small and large ones by their power, 2e-4, which keeps labels short.
std::string number_of_power(double place, double factor, int power) {
  if (power >= -2 && power <= 4) return number(place);
  return number(factor) + "e" + std::to_string(power);
}

Range padded(Range range, double share) {
  if (!(range.low <= range.high)) return {0, 1};
  double room = (range.high - range.low) * share;
  if (room < 1e-12 * std::max(1e-30, std::abs(range.high))) room = std::max(std::abs(range.high) * 0.05, 1e-12);
  return {range.low - room, range.high + room};
}

// Where the parts of a chart are, and the ranges of its axes.
struct Layout {
  const Chart& chart;
  Point upper_left, lower_right;  // corners of the area for curves
  Range x, y;                     // ranges of the axes; of logarithms on a logarithmic axis

  Point place(double px, double py) const {
    const double u = (even(px, chart.logarithmic_x) - x.low) / (x.high - x.low);
    const double v = (even(py, chart.logarithmic_y) - y.low) / (y.high - y.low);
    return {upper_left.x + u * (lower_right.x - upper_left.x), lower_right.y - v * (lower_right.y - upper_left.y)};
  }
};

// Positions of the entries of the legend, relative to the chart's corner. They are below the title, as many in a line
// as fit, so that they hide no curve.
std::vector<Point> legend_places(const Chart& chart, int width) {
  std::vector<Point> places;
  const double left = least_left_margin;
  Point at{left, title_height + legend_line / 2};
  for (const Series& series : chart.series) {
    const double needed = series.name.empty() ? 0 : legend_stroke + 32 + Canvas::text_width(series.name, text_size);
    if (at.x > left && at.x + needed > width - right_margin) at = {left, at.y + legend_line};
    places.push_back(at);
    at.x += needed;
  }
  return places;
}

double top_margin(const Chart& chart, int width) {
  double bottom = title_height + 8;
  const std::vector<Point> places = legend_places(chart, width);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!chart.series[i].name.empty()) bottom = std::max(bottom, places[i].y + legend_line);
  return bottom;
}

Ticks ticks_of_y(const Chart& chart, const Range& y) {
  return chart.logarithmic_y ? logarithmic_ticks(y.low, y.high, 6) : linear_ticks(y.low, y.high, 6);
}

/// The room for the axis title, and for tick labels beside it.
double left_margin(const Ticks& ticks) {
  double widest = 0;
  for (const std::string& label : ticks.labels) widest = std::max(widest, Canvas::text_width(label, text_size));
  return std::max(least_left_margin, title_right + 8 + widest + label_distance);
}

Layout lay_out(const Chart& chart, Point corner, int width, int height) {
  Range x, y;
  for (const Series& series : chart.series)
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      const double u = even(series.x[i], chart.logarithmic_x), v = even(series.y[i], chart.logarithmic_y);
      if (!std::isfinite(u) || !std::isfinite(v)) continue;
      x.include(u);
      y.include(v);
    }
  if (chart.shows_zero) y.include(0);
  x = padded(x, 0.02);
  y = padded(y, 0.08);
  return {chart,
          {corner.x + left_margin(ticks_of_y(chart, y)), corner.y + top_margin(chart, width)},
          {corner.x + width - right_margin, corner.y + height - 66},
          x,
          y};
}

void draw_grid(Canvas& canvas, const Layout& layout) {
  const Chart& chart = layout.chart;
  const Point a = layout.upper_left, b = layout.lower_right;
  const Ticks xs = chart.logarithmic_x ? logarithmic_ticks(layout.x.low, layout.x.high, 7)
                                       : linear_ticks(layout.x.low, layout.x.high, 7);
  const Ticks ys = ticks_of_y(chart, layout.y);
  for (std::size_t i = 0; i < xs.places.size(); ++i) {
    const double x = layout.place(xs.places[i], 1).x;
    canvas.line({x, a.y}, {x, b.y}, 1, faint);
    canvas.line({x, b.y}, {x, b.y + 5}, 1, frame);
    canvas.text({x - Canvas::text_width(xs.labels[i], text_size) / 2, b.y + 12}, xs.labels[i], text_size, ink);
  }
  for (std::size_t i = 0; i < ys.places.size(); ++i) {
    const double y = layout.place(1, ys.places[i]).y;
    canvas.line({a.x, y}, {b.x, y}, 1, faint);
    canvas.line({a.x - 5, y}, {a.x, y}, 1, frame);
    const double width = Canvas::text_width(ys.labels[i], text_size);
    canvas.text({a.x - label_distance - width, y - font_height * text_size / 2}, ys.labels[i], text_size, ink);
  }
}

void draw_frame(Canvas& canvas, const Layout& layout, Point corner, int height) {
  const Chart& chart = layout.chart;
  const Point a = layout.upper_left, b = layout.lower_right;
  canvas.line({a.x, a.y}, {a.x, b.y}, 1.5, frame);
  canvas.line({a.x, b.y}, {b.x, b.y}, 1.5, frame);
  canvas.text({a.x, corner.y + 20}, chart.title, title_size, ink);
  const double x_width = Canvas::text_width(chart.x_label, text_size);
  canvas.text({(a.x + b.x - x_width) / 2, corner.y + height - 28}, chart.x_label, text_size, ink);
  // Beside the axis, or where the title is longer than that, within the chart.
  const double y_width = Canvas::text_width(chart.y_label, text_size), low = corner.y + height - 6;
  const double start = std::min((a.y + b.y + y_width) / 2, low);
  canvas.text_upwards({corner.x + title_left, start}, chart.y_label, text_size, ink);
}

// Draws a segment of a dashed line from `offset` in the dash pattern. Returns the offset at its end.
double dashes(Canvas& canvas, Point from, Point to, double offset, Colour colour) {
  constexpr double on = 9, period = 16;
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  auto at = [&](double s) {
    return Point{from.x + (to.x - from.x) * s / length, from.y + (to.y - from.y) * s / length};
  };
  for (double start = -offset; length > 0 && start < length; start += period)
    if (start + on > 0) canvas.line(at(std::max(start, 0.0)), at(std::min(start + on, length)), 2, colour);
  return std::fmod(offset + length, period);
}

void draw_series(Canvas& canvas, const Layout& layout, const Series& series, Colour colour) {
  double offset = 0;
  const std::size_t count = std::min(series.x.size(), series.y.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Point here = layout.place(series.x[i], series.y[i]);
    if (!std::isfinite(here.x) || !std::isfinite(here.y)) continue;
    if (series.style == Series::Style::points) {
      canvas.disc(here, 4.5, paper);
      canvas.disc(here, 3.5, colour);
      continue;
    }
    if (i == 0) continue;
    const Point before = layout.place(series.x[i - 1], series.y[i - 1]);
    if (!std::isfinite(before.x) || !std::isfinite(before.y)) continue;
    if (series.style == Series::Style::dashed)
      offset = dashes(canvas, before, here, offset, colour);
    else
      canvas.line(before, here, 2.2, colour);
  }
}

void draw_sample(Canvas& canvas, Series::Style style, Point from, Colour colour) {
  const Point to{from.x + legend_stroke, from.y};
  if (style == Series::Style::points)
    canvas.disc({(from.x + to.x) / 2, from.y}, 4, colour);
  else if (style == Series::Style::dashed)
    dashes(canvas, from, to, 0, colour);
  else
    canvas.line(from, to, 2.2, colour);
}

void draw_legend(Canvas& canvas, const Chart& chart, Point corner, int width) {
  const std::vector<Point> places = legend_places(chart, width);
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const Series& series = chart.series[i];
    if (series.name.empty()) continue;
    const Point at{corner.x + places[i].x, corner.y + places[i].y};
    draw_sample(canvas, series.style, at, colour_of(chart, i));
    canvas.text({at.x + legend_stroke + 8, at.y - font_height * text_size / 2 + 1}, series.name, text_size, ink);
  }
}

void draw_chart(Canvas& canvas, const Chart& chart, Point corner, int width, int height) {
  const Layout layout = lay_out(chart, corner, width, height);
  draw_grid(canvas, layout);
  draw_frame(canvas, layout, corner, height);
  canvas.clip(layout.upper_left, layout.lower_right);
  for (std::size_t i = 0; i < chart.series.size(); ++i)
    draw_series(canvas, layout, chart.series[i], colour_of(chart, i));
  canvas.unclip();
  draw_legend(canvas, chart, corner, width);
}

}  // namespace

Ticks linear_ticks(double low, double high, int wanted) {
  Ticks ticks;
  if (!(high > low) || wanted < 1) return ticks;
  const double power = std::pow(10, std::floor(std::log10((high - low) / wanted)));
  double step = power;
  for (double factor : {2.0, 5.0, 10.0})
    if ((high - low) / step > wanted) step = factor * power;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) {
    const double place = std::abs(k) < 0.5 ? 0 : k * step;
    ticks.places.push_back(place);
    ticks.labels.push_back(number(place));
  }
  return ticks;
}

Ticks logarithmic_ticks(double low, double high, int wanted) {
  Ticks ticks;
  const int first = static_cast<int>(std::ceil(low - 1e-9)), last = static_cast<int>(std::floor(high + 1e-9));
  const bool fine = last - first < 2;  // less than two decades: also ticks at 2 and 5 times powers of ten
  const int stride = std::max(1, (last - first) / std::max(wanted, 1));
  for (int k = first - 1; k <= last; k += 1) {
    for (double factor : {1.0, 2.0, 5.0}) {
      const double place = factor * std::pow(10, k), level = std::log10(place);
      if (level < low - 1e-9 || level > high + 1e-9) continue;
      if (factor > 1 && !fine) continue;
      if (factor == 1 && (k - first) % stride != 0) continue;
      ticks.places.push_back(place);
      ticks.labels.push_back(number_of_power(place, factor, k));
    }
  }
  // Within a decade there may be fewer than three ticks; then place ticks at round numbers, which are at uneven
  // distances.
  return ticks.places.size() < 3 ? linear_ticks(std::pow(10, low), std::pow(10, high), wanted) : ticks;
}

Canvas paint(const std::vector<Chart>& charts, int columns, int width, int height) {
  const int count = std::max(1, static_cast<int>(charts.size()));
  const int across = std::clamp(columns, 1, count), down = (count + across - 1) / across;
  Canvas canvas(across * width, down * height, paper);
  for (int i = 0; i < static_cast<int>(charts.size()); ++i) {
    const Point corner{static_cast<double>(i % across * width), static_cast<double>(i / across * height)};
    draw_chart(canvas, charts[static_cast<std::size_t>(i)], corner, width, height);
  }
  return canvas;
}

}  // namespace pliant::plot
