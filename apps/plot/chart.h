// Line charts as data, and their painting, for `pliant validate --plot` and `pliant compare`.
#pragma once

#include <string>
#include <vector>

#include "apps/plot/canvas.h"

namespace pliant::plot {

/// One curve. Points that are not finite (or not positive on a logarithmic axis) leave a gap.
struct Series {
  enum class Style { line, dashed, points };
  std::string name;  ///< name in the legend
  std::vector<double> x, y;
  Style style = Style::line;
  int colour = -1;  ///< palette index, so that a curve has the same colour in several charts; -1: its index in the chart
};

/// Axes with curves.
struct Chart {
  std::string title, x_label, y_label;
  bool logarithmic_x = false, logarithmic_y = false;
  std::vector<Series> series;
};

/// The ticks of an axis and their labels.
struct Ticks {
  std::vector<double> places;
  std::vector<std::string> labels;
};

/// Ticks at 1, 2 or 5 times a power of ten within [low, high], about `wanted` of them.
Ticks linear_ticks(double low, double high, int wanted);
/// Ticks at powers of ten within 10^low and 10^high, thinned out to `wanted`. Over less than two decades also at 2 and 5
/// times these; with fewer than three ticks, as linear_ticks.
Ticks logarithmic_ticks(double low, double high, int wanted);

/// The charts in a grid of `columns` columns, each `width` x `height` pixels.
Canvas paint(const std::vector<Chart>& charts, int columns = 2, int width = 760, int height = 500);

}  // namespace pliant::plot
