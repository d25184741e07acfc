// Paints shapes: how much of a pixel is covered is the depth of its centre inside the shape, clamped to 0..1.
#include "apps/plot/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/plot/font.h"
#include "pliant/error.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include "stb_easy_font.h"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include "stb_image_write.h"
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace pliant::plot {
namespace {

constexpr int largest_side = 16384;

// Of a font, for text of size 1: its size, and where its baseline is below the upper edge of the text [pixels].
constexpr double em = 8.2, baseline = 6.6;

// A corner of a rectangle as stb_easy_font returns it.
struct FontCorner {
  float x, y, z;
  std::uint8_t colour[4];
};
using FontBox = std::array<FontCorner, 4>;

std::string printable(const std::string& words) {
  std::string result;
  std::copy_if(words.begin(), words.end(), std::back_inserter(result), [](char c) { return c >= ' ' && c <= '~'; });
  return result;
}

// The letters of a line of text as boxes in pixels of the font.
std::vector<FontBox> letter_boxes(const std::string& words) {
  std::string line = printable(words);
  std::vector<FontBox> boxes(line.size() * 10 + 10);
  const int size = static_cast<int>(boxes.size() * sizeof(FontBox));
  boxes.resize(static_cast<std::size_t>(stb_easy_font_print(0, 0, line.data(), nullptr, boxes.data(), size)));
  return boxes;
}

double distance_to_segment(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double along = squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - along * dx, p.y - a.y - along * dy);
}

// How much of the pixel [i, i + 1] the interval [low, high] covers, 0..1.
double overlap(int i, double low, double high) {
  return std::clamp(std::min(high, i + 1.0) - std::max(low, static_cast<double>(i)), 0.0, 1.0);
}

int pixel_before(double value, int low, int high) {
  return static_cast<int>(std::clamp(std::floor(value), static_cast<double>(low), static_cast<double>(high)));
}

bool finite(Point p) { return std::isfinite(p.x) && std::isfinite(p.y); }

}  // namespace

Canvas::Canvas(int width, int height, Colour background) : width_(width), height_(height) {
  if (width < 1 || height < 1 || width > largest_side || height > largest_side)
    throw Error({},
                "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels cannot be created",
                "use 1 to " + std::to_string(largest_side) + " on either side");
  pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (std::size_t i = 0; i < pixels_.size(); i += 3) {
    pixels_[i] = background.red;
    pixels_[i + 1] = background.green;
    pixels_[i + 2] = background.blue;
  }
  unclip();
}

void Canvas::clip(Point upper_left, Point lower_right) {
  left_ = pixel_before(upper_left.x, 0, width_);
  top_ = pixel_before(upper_left.y, 0, height_);
  right_ = pixel_before(lower_right.x + 1, 0, width_);
  bottom_ = pixel_before(lower_right.y + 1, 0, height_);
}

void Canvas::unclip() {
  left_ = top_ = 0;
  right_ = width_;
  bottom_ = height_;
}

void Canvas::blend(int x, int y, Colour colour, double share) {
  if (share <= 0) return;
  std::uint8_t* pixel =
      &pixels_[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)) * 3];
  const std::uint8_t paint[3] = {colour.red, colour.green, colour.blue};
  for (int i = 0; i < 3; ++i)
    pixel[i] = static_cast<std::uint8_t>(std::lround(pixel[i] + (paint[i] - pixel[i]) * std::min(share, 1.0)));
}

void Canvas::line(Point from, Point to, double thickness, Colour colour, double opacity) {
  if (!finite(from) || !finite(to)) return;
  const double reach = thickness / 2 + 1;
  const int x0 = pixel_before(std::min(from.x, to.x) - reach, left_, right_);
  const int x1 = pixel_before(std::max(from.x, to.x) + reach + 1, left_, right_);
  const int y0 = pixel_before(std::min(from.y, to.y) - reach, top_, bottom_);
  const int y1 = pixel_before(std::max(from.y, to.y) + reach + 1, top_, bottom_);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const double away = distance_to_segment({x + 0.5, y + 0.5}, from, to);
      blend(x, y, colour, opacity * std::clamp(thickness / 2 + 0.5 - away, 0.0, 1.0));
    }
}

void Canvas::disc(Point centre, double radius, Colour colour) { line(centre, centre, 2 * radius, colour); }

void Canvas::rectangle(Point upper_left, Point lower_right, Colour colour, double opacity) {
  if (!finite(upper_left) || !finite(lower_right)) return;
  const int x0 = pixel_before(upper_left.x, left_, right_), x1 = pixel_before(lower_right.x + 1, left_, right_);
  const int y0 = pixel_before(upper_left.y, top_, bottom_), y1 = pixel_before(lower_right.y + 1, top_, bottom_);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      blend(x, y, colour, opacity * overlap(x, upper_left.x, lower_right.x) * overlap(y, upper_left.y, lower_right.y));
}

void Canvas::letter_pixel(int x, int y, Colour colour, double share) {
  if (x >= left_ && x < right_ && y >= top_ && y < bottom_) blend(x, y, colour, share);
}

void Canvas::text(Point at, const std::string& words, double size, Colour colour) {
  if (has_font()) {
    const int left = static_cast<int>(std::floor(at.x)), base = static_cast<int>(std::lround(at.y + baseline * size));
    const auto paint = [&](int x, int y, double share) { letter_pixel(left + x, base + y, colour, share); };
    return paint_letters(printable(words), em * size, at.x - left, paint);
  }
  for (const FontBox& box : letter_boxes(words))
    rectangle({at.x + size * static_cast<double>(box[0].x), at.y + size * static_cast<double>(box[0].y)},
              {at.x + size * static_cast<double>(box[2].x), at.y + size * static_cast<double>(box[2].y)}, colour);
}

void Canvas::text_upwards(Point at, const std::string& words, double size, Colour colour) {
  if (has_font()) {
    const int low = static_cast<int>(std::floor(at.y)), base = static_cast<int>(std::lround(at.x + baseline * size));
    const auto paint = [&](int x, int y, double share) { letter_pixel(base + y, low - x, colour, share); };
    return paint_letters(printable(words), em * size, 0, paint);
  }
  for (const FontBox& box : letter_boxes(words))
    rectangle({at.x + size * static_cast<double>(box[0].y), at.y - size * static_cast<double>(box[2].x)},
              {at.x + size * static_cast<double>(box[2].y), at.y - size * static_cast<double>(box[0].x)}, colour);
}

double Canvas::text_width(const std::string& words, double size) {
  std::string line = printable(words);
  return has_font() ? font_width(line, em * size) : size * stb_easy_font_width(line.data());
}

void write_png(const std::string& path, const Canvas& canvas) {
  Location where;
  where.file = path;
  if (!stbi_write_png(path.c_str(), canvas.width(), canvas.height(), 3, canvas.pixels().data(), 3 * canvas.width()))
    throw Error(where, "cannot write the picture", "check that the folder exists, is writable and has space");
}

}  // namespace pliant::plot
