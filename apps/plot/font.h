// Letters of a TrueType font, where the machine has one.
#pragma once

#include <functional>
#include <string>

namespace pliant::plot {

/// Paints a share of the pixel (x, y), where x goes along the text from its start and y downwards from its baseline.
using PaintPixel = std::function<void(int x, int y, double share)>;

/// True if there is a font: DejaVu Sans, of the Debian package fonts-dejavu-core.
bool has_font();

/// The width of a line of printable ASCII [pixels]. `em` is the size of the font [pixels].
double font_width(const std::string& line, double em);

/// Paints a line of printable ASCII. `shift` is where it starts, 0..1 of a pixel.
void paint_letters(const std::string& line, double em, double shift, const PaintPixel& paint);

}  // namespace pliant::plot
