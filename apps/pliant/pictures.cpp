#include "pictures.h"

#include <algorithm>
#include <charconv>

#include "pliant/error.h"

namespace pliant::command {

namespace {

constexpr int gap = 4;  // white pixels between two pictures

render::Quality quality_of(const RenderOptions& options) {
  return options.draft ? render::Quality::draft : render::Quality::full;
}

View view_of(const std::vector<render::RenderScene>& moments, const RenderOptions& options, int width, int height) {
  return {render::frame_camera(moments, width, height, options.camera), render::extent_of(moments)};
}

int step_of(const RenderOptions& options, double frame_time) {
  constexpr double rate_of_draft = 15;
  return options.draft ? static_cast<int>(std::clamp(1 / (frame_time * rate_of_draft), 1.0, 1e6) + 0.5) : 1;
}

}  // namespace

Size parse_size(const std::string& text) {
  Size size{};
  const char* end = text.data() + text.size();
  const auto [after_width, width_error] = std::from_chars(text.data(), end, size.width);
  if (width_error == std::errc() && after_width != end && (*after_width == 'x' || *after_width == 'X')) {
    const auto [after_height, height_error] = std::from_chars(after_width + 1, end, size.height);
    if (height_error == std::errc() && after_height == end) return size;
  }
  throw Error({}, "--size " + text + " is not a size", "give width and height in pixels, such as 1280x720");
}

SideBySide::SideBySide(const RenderOptions& options, const Size& size, std::size_t count)
    : options_(options),
      size_(size),
      panel_((size.width - gap * (static_cast<int>(count) - 1)) / static_cast<int>(count)),
      renderer_(panel_, size.height, quality_of(options)) {}

void SideBySide::draw(std::vector<render::RenderScene> moments) {
  const View view = view_of(moments, options_, panel_, size_.height);
  const std::size_t row = std::size_t{3} * static_cast<std::size_t>(size_.width);
  const std::size_t panel_row = std::size_t{3} * static_cast<std::size_t>(panel_);
  std::vector<std::uint8_t> strip(row * static_cast<std::size_t>(size_.height), 255);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    view.apply(moments[i]);
    const std::vector<std::uint8_t> pixels = renderer_.draw(moments[i]);
    const std::size_t left = i * (panel_row + std::size_t{3} * gap);
    for (std::size_t y = 0; y < static_cast<std::size_t>(size_.height); ++y)
      std::copy_n(pixels.begin() + static_cast<std::ptrdiff_t>(y * panel_row), panel_row,
                  strip.begin() + static_cast<std::ptrdiff_t>(y * row + left));
  }
  render::write_png(options_.out, size_.width, size_.height, strip);
}

Movie::Movie(const RenderOptions& options, const Size& size, double frame_time)
    : options_(options),
      size_(size),
      every_(step_of(options, frame_time)),
      renderer_(size.width, size.height, quality_of(options)),
      writer_(options.out, size.width, size.height, std::clamp(1 / (frame_time * every_), 1.0, 240.0)) {}

void Movie::see(const std::vector<render::RenderScene>& moments) {
  view_ = view_of(moments, options_, size_.width, size_.height);
}

void Movie::add(render::RenderScene picture) {
  view_.apply(picture);
  writer_.add(renderer_.draw(picture));
}

}  // namespace pliant::command
