#include "apps/plot/font.h"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <vector>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include "stb_truetype.h"
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace pliant::plot {

namespace {

struct Font {
  std::vector<unsigned char> file;
  stbtt_fontinfo info{};
  bool is_there = false;

  Font() {
    std::ifstream in("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", std::ios::binary);
    file.assign(std::istreambuf_iterator<char>(in), {});
    is_there = !file.empty() && stbtt_InitFont(&info, file.data(), 0) != 0;
  }
};

const Font& the_font() {
  static const Font font;
  return font;
}

/// How far the next letter is from this one [units of the font].
int advance(const stbtt_fontinfo& font, char letter, char next) {
  int width = 0, bearing = 0;
  stbtt_GetCodepointHMetrics(&font, letter, &width, &bearing);
  return width + (next == 0 ? 0 : stbtt_GetCodepointKernAdvance(&font, letter, next));
}

}  // namespace

bool has_font() { return the_font().is_there; }

double font_width(const std::string& line, double em) {
  const stbtt_fontinfo& font = the_font().info;
  double width = 0;
  for (std::size_t i = 0; i < line.size(); ++i)
    width += advance(font, line[i], i + 1 < line.size() ? line[i + 1] : '\0');
  return width * static_cast<double>(stbtt_ScaleForMappingEmToPixels(&font, static_cast<float>(em)));
}

void paint_letters(const std::string& line, double em, double shift, const PaintPixel& paint) {
  const stbtt_fontinfo& font = the_font().info;
  const float scale = stbtt_ScaleForMappingEmToPixels(&font, static_cast<float>(em));
  double x = shift;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double whole = std::floor(x);
    int width = 0, height = 0, left = 0, top = 0;
    unsigned char* const bitmap = stbtt_GetCodepointBitmapSubpixel(&font, scale, scale, static_cast<float>(x - whole),
                                                                   0, line[i], &width, &height, &left, &top);
    for (int row = 0; row < height; ++row)
      for (int column = 0; column < width; ++column)
        paint(static_cast<int>(whole) + left + column, top + row, bitmap[row * width + column] / 255.0);
    stbtt_FreeBitmap(bitmap, nullptr);
    x += advance(font, line[i], i + 1 < line.size() ? line[i + 1] : '\0') * static_cast<double>(scale);
  }
}

}  // namespace pliant::plot
