// A picture in memory that lines, boxes and letters are painted on. Charts need nothing more, so nothing more is here:
// every shape is painted by its distance to the pixel's centre, which smooths edges without an oversized buffer.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pliant::plot {

/// Red, green and blue, 0..255, as a screen shows them.
struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// A place on the canvas in pixels, from the upper left corner.
struct Point {
  double x = 0, y = 0;
};

class Canvas {
 public:
  /// A canvas of one colour. Throws Error unless both sides are in 1..16384.
  Canvas(int width, int height, Colour background);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }  ///< rows from the top, three bytes a pixel

  /// A stroke with round ends.
  void line(Point from, Point to, double thickness, Colour colour, double opacity = 1);
  void disc(Point centre, double radius, Colour colour);
  void rectangle(Point upper_left, Point lower_right, Colour colour, double opacity = 1);

  /// Letters (ASCII; others are left out) `size` times 7 pixels high, its upper left corner at `at`.
  void text(Point at, const std::string& words, double size, Colour colour);
  /// The same turned by a quarter against the clock, its lower left corner at `at`.
  void text_upwards(Point at, const std::string& words, double size, Colour colour);
  static double text_width(const std::string& words, double size);

  /// Keeps what is painted from now on within this box.
  void clip(Point upper_left, Point lower_right);
  void unclip();

 private:
  void blend(int x, int y, Colour colour, double share);

  int width_, height_;
  std::vector<std::uint8_t> pixels_;
  int left_, top_, right_, bottom_;  // what may be painted, the far side not included
};

/// Writes a PNG. Throws Error naming the path where it can't.
void write_png(const std::string& path, const Canvas& canvas);

}  // namespace pliant::plot
