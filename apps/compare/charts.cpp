// Draws six charts: the residual, the largest stretch and its 99th percentile, each over iterations and over
// milliseconds.
#include <algorithm>
#include <limits>

#include "apps/compare/compare.h"

namespace pliant::compare {

namespace {

plot::Chart panel(const std::string& title, const std::string& x, const std::string& y) {
  plot::Chart chart;
  chart.title = title;
  chart.x_label = x;
  chart.y_label = y;
  chart.logarithmic_x = chart.logarithmic_y = true;
  return chart;
}

/// A curve of f(sample) in the colour that the method has in all charts.
template <class X, class Y>
plot::Series line(const Curve& curve, int colour, const X& x, const Y& y) {
  plot::Series series;
  series.name = curve.name;
  series.colour = colour;
  for (const Sample& sample : curve.samples) {
    series.x.push_back(x(sample));
    series.y.push_back(y(sample));
  }
  return series;
}

double iterations_of(const Sample& sample) { return sample.iterations; }
double milliseconds_of_sample(const Sample& sample) { return sample.milliseconds; }
double largest_of(const Sample& sample) { return percent(sample.stretch.largest); }
double p99_of(const Sample& sample) { return percent(sample.stretch.p99); }

constexpr int start_colour = 8;  // last colour of the palette, which a sweep has only if nine are compared

/// All iterations but the prediction, whose number 0 has no place on a logarithmic axis.
template <class X>
plot::Series recorded(const Curve& curve, int colour, double scale, const X& x) {
  plot::Series series;
  series.name = curve.name;
  series.colour = colour;
  for (std::size_t i = 1; i < curve.residuals.size(); ++i) {
    series.x.push_back(x(curve, static_cast<int>(i)));
    series.y.push_back(scale * curve.residuals[i]);
  }
  return series;
}

/// A horizontal line at the residual of the prediction, from which all methods start.
plot::Series start_of(const Result& result, double scale, const plot::Chart& chart) {
  plot::Series series;
  series.name = "at the start";
  series.style = plot::Series::Style::dashed;
  series.colour = start_colour;
  double first = std::numeric_limits<double>::infinity(), last = 0;
  for (const plot::Series& other : chart.series) {
    first = std::min(first, other.x.front());
    last = std::max(last, other.x.back());
  }
  series.x = {first, last};
  series.y.assign(2, scale * result.curves.front().residuals.front());
  return series;
}

template <class X>
plot::Chart residual_panel(const Result& result, const std::string& against, const std::string& x_label, const X& x) {
  const bool length = result.residual_type == "distance";
  const double scale = length ? 1000 : 1;
  const std::string error = length ? "rms error of lengths [mm]" : "rms error of " + result.residual_type;
  plot::Chart chart = panel("Residual, by " + against, x_label, error);
  int colour = 0;
  for (const Curve& curve : result.curves) chart.series.push_back(recorded(curve, colour++, scale, x));
  chart.series.push_back(start_of(result, scale, chart));
  return chart;
}

template <class X, class Y>
plot::Chart stretch_panel(const Result& result, const std::string& title, const std::string& x_label, const X& x,
                          const Y& y) {
  plot::Chart chart = panel(title, x_label, "beyond rest length [%]");
  int colour = 0;
  for (const Curve& curve : result.curves) chart.series.push_back(line(curve, colour++, x, y));
  return chart;
}

}  // namespace

std::vector<plot::Chart> to_charts(const Result& result) {
  const std::string time = times_next(result) ? "milliseconds of the next substep" : "milliseconds of the substep",
                    count = "iterations";
  const auto iteration = [](const Curve&, int number) { return static_cast<double>(number); };
  return {residual_panel(result, "iterations", count, iteration),
          residual_panel(result, "time", time, milliseconds_at),
          stretch_panel(result, "Largest stretch, by iterations", count, iterations_of, largest_of),
          stretch_panel(result, "Largest stretch, by time", time, milliseconds_of_sample, largest_of),
          stretch_panel(result, "Stretch that 1 edge in 100 exceeds, by iterations", count, iterations_of, p99_of),
          stretch_panel(result, "Stretch that 1 edge in 100 exceeds, by time", time, milliseconds_of_sample, p99_of)};
}

}  // namespace pliant::compare
