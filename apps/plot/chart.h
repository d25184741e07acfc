// Line charts as data, and their painting, for `pliant validate --plot` and `pliant compare`.
#pragma once

#include <string>
#include <vector>

#include "apps/plot/canvas.h"

namespace pliant::plot {

/// A curve. It has a gap where a point is not finite, or not positive on a logarithmic axis.
struct Series {
  enum class Style { line, dashed, points };
  std::string name;  ///< name in the legend
  std::vector<double> x, y;
  Style style = Style::line;
  int colour = -1;  ///< index in the palette, to give a curve the same colour in several charts; -1: its own index
};

/// A chart: axes and curves.
struct Chart {
  std::string title, x_label, y_label;
  bool logarithmic_x = false, logarithmic_y = false;
  std::vector<Series> series;
  bool shows_zero = false;  ///< true: the y-axis has 0, so that small differences look small; not for a logarithmic one
};

/// The positions of ticks on an axis, and their labels.
struct Ticks {
  std::vector<double> places;
  std::vector<std::string> labels;
};

/// Finds about `wanted` ticks within [low, high], at 1, 2 or 5 times a power of ten.
Ticks linear_ticks(double low, double high, int wanted);
/// Finds at most about `wanted` ticks between 10^low and 10^high, at powers of ten. Over less than two decades they are
/// also at 2 and 5 times these; if fewer than three remain, as linear_ticks has them.
Ticks logarithmic_ticks(double low, double high, int wanted);

/// Paints charts in `columns` columns, each `width` x `height` pixels.
Canvas paint(const std::vector<Chart>& charts, int columns = 2, int width = 760, int height = 500);

}  // namespace pliant::plot
