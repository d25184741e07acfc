// An in-memory picture with lines, boxes and text, for charts. Shapes are painted by
// the distance of each pixel's centre, which smooths edges without supersampling.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pliant::plot {

/// Red, green and blue, 0..255, in sRGB.
struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// A position on the canvas in pixels, from the upper left corner.
struct Point {
  double x = 0, y = 0;
};

class Canvas {
 public:
  /// A canvas of one colour. Throws an Error unless both sides are in 1..16384.
  Canvas(int width, int height, Colour background);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }  ///< rows from the top, three bytes per pixel

  /// A stroke with round ends.
  void line(Point from, Point to, double thickness, Colour colour, double opacity = 1);
  void disc(Point centre, double radius, Colour colour);
  void rectangle(Point upper_left, Point lower_right, Colour colour, double opacity = 1);

  /// Text (ASCII; other characters are skipped), `size` times 7 pixels high, with its upper left corner at `at`.
  void text(Point at, const std::string& words, double size, Colour colour);
  /// The same, rotated counter-clockwise by 90 degrees, with its lower left corner at `at`.
  void text_upwards(Point at, const std::string& words, double size, Colour colour);
  static double text_width(const std::string& words, double size);

  /// Restricts later painting to this box.
  void clip(Point upper_left, Point lower_right);
  void unclip();

 private:
  void blend(int x, int y, Colour colour, double share);

  int width_, height_;
  std::vector<std::uint8_t> pixels_;
  int left_, top_, right_, bottom_;  // the clip box; right and bottom are exclusive
};

/// Writes a PNG. Throws an Error that names the path on failure.
void write_png(const std::string& path, const Canvas& canvas);

}  // namespace pliant::plot
