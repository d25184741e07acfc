// Four panels: what an iteration buys, and what a millisecond buys; of the error that is solved for, and of what is seen.
#include "apps/compare/compare.h"

namespace pliant::compare {

namespace {

double percent(double ratio) { return 100 * (ratio - 1); }

plot::Chart panel(const std::string& title, const std::string& x, const std::string& y) {
  plot::Chart chart;
  chart.title = title;
  chart.x_label = x;
  chart.y_label = y;
  chart.logarithmic_x = chart.logarithmic_y = true;
  return chart;
}

/// A line through f(sample) in the method's own colour, which is the same in every panel.
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
double milliseconds_of(const Sample& sample) { return sample.milliseconds; }
double largest_of(const Sample& sample) { return percent(sample.stretch.largest); }
double p99_of(const Sample& sample) { return percent(sample.stretch.p99); }

/// Every iteration, which the record has; the first is no place on a logarithmic axis.
plot::Series recorded(const Curve& curve, int colour, double scale) {
  plot::Series series;
  series.name = curve.name;
  series.colour = colour;
  for (std::size_t i = 1; i < curve.residuals.size(); ++i) {
    series.x.push_back(static_cast<double>(i));
    series.y.push_back(scale * curve.residuals[i]);
  }
  return series;
}

template <class X>
void add_stretch(const Curve& curve, int colour, const X& x, plot::Chart& chart) {
  chart.series.push_back(line(curve, colour, x, largest_of));
  plot::Series p99 = line(curve, colour, x, p99_of);
  p99.name.clear();
  p99.style = plot::Series::Style::dashed;
  chart.series.push_back(p99);
}

}  // namespace

std::vector<plot::Chart> to_charts(const Result& result) {
  const bool length = result.residual_type == "distance";
  const double scale = length ? 1000 : 1;
  const std::string residual = length ? "rms error of lengths [mm]" : "rms error of " + result.residual_type;
  const auto residual_of = [&](const Sample& sample) { return scale * sample.residual; };
  const std::string stretch = "beyond rest length [%]", time = "milliseconds of the substep", count = "iterations";
  std::vector<plot::Chart> charts{panel("Residual, by iterations", count, residual),
                                  panel("Residual, by time", time, residual),
                                  panel("Largest stretch (dashed: p99), by iterations", count, stretch),
                                  panel("Largest stretch (dashed: p99), by time", time, stretch)};
  int colour = 0;
  for (const Curve& curve : result.curves) {
    charts[0].series.push_back(recorded(curve, colour, scale));
    charts[1].series.push_back(line(curve, colour, milliseconds_of, residual_of));
    add_stretch(curve, colour, iterations_of, charts[2]);
    add_stretch(curve, colour, milliseconds_of, charts[3]);
    ++colour;
  }
  return charts;
}

}  // namespace pliant::compare
