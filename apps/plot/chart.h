// Line charts as data, and how to paint them: `pliant validate --plot` and `pliant compare` show their curves with these.
#pragma once

#include <string>
#include <vector>

#include "apps/plot/canvas.h"

namespace pliant::plot {

/// One curve. Points that are not finite (or not positive on a logarithmic axis) leave a gap.
struct Series {
  enum class Style { line, dashed, points };
  std::string name;  ///< for the legend
  std::vector<double> x, y;
  Style style = Style::line;
  int colour = -1;  ///< of the palette, so that a curve looks alike in several charts; -1: as its place in the chart has it
};

/// Axes with curves.
struct Chart {
  std::string title, x_label, y_label;
  bool logarithmic_x = false, logarithmic_y = false;
  std::vector<Series> series;
};

/// Where an axis puts its marks, and what it writes there.
struct Ticks {
  std::vector<double> places;
  std::vector<std::string> labels;
};

/// Marks at 1, 2 or 5 times a power of ten within [low, high], about `wanted` of them.
Ticks linear_ticks(double low, double high, int wanted);
/// Marks at powers of ten within 10^low and 10^high, thinned out to `wanted`; over less than two decades also at 2 and 5 times
/// these, and where even that makes fewer than three, as linear_ticks has it.
Ticks logarithmic_ticks(double low, double high, int wanted);

/// The charts side by side and below each other, `columns` a row, each `width` x `height` pixels.
Canvas paint(const std::vector<Chart>& charts, int columns = 2, int width = 760, int height = 500);

}  // namespace pliant::plot
