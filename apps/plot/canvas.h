// A picture in memory with lines, boxes and text, for charts. How much of a pixel a shape covers follows from the
// distance of the pixel's centre, so edges are smooth without supersampling.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pliant::plot {

/// A colour: red, green and blue, 0..255, in sRGB.
struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// A position on the canvas in pixels, from the upper left corner.
struct Point {
  double x = 0, y = 0;
};

class Canvas {
 public:
  /// Makes a canvas of one colour. Throws an Error unless both sides are in 1..16384 pixels.
  Canvas(int width, int height, Colour background);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<std::uint8_t>& pixels() const {
    return pixels_;
  }  ///< rows from the top; red, green and blue of each pixel

  /// Draws a line with round ends.
  void line(Point from, Point to, double thickness, Colour colour, double opacity = 1);
  void disc(Point centre, double radius, Colour colour);
  void rectangle(Point upper_left, Point lower_right, Colour colour, double opacity = 1);

  /// Draws text that is `size` times 7 pixels high, with its upper left corner at `at`, in DejaVu Sans where the
  /// machine has it, else in strokes. Characters that are not ASCII are skipped.
  void text(Point at, const std::string& words, double size, Colour colour);
  /// Draws text that runs upwards, with its lower left corner at `at`.
  void text_upwards(Point at, const std::string& words, double size, Colour colour);
  static double text_width(const std::string& words, double size);

  /// Restricts what is painted afterwards to this box.
  void clip(Point upper_left, Point lower_right);
  void unclip();

 private:
  void blend(int x, int y, Colour colour, double share);
  void letter_pixel(int x, int y, Colour colour, double share);

  int width_, height_;
  std::vector<std::uint8_t> pixels_;
  int left_, top_, right_, bottom_;  // painting is restricted to this box; right and bottom are exclusive
};

/// Writes a canvas as PNG. If that fails, throws an Error that names the path.
void write_png(const std::string& path, const Canvas& canvas);

}  // namespace pliant::plot
