// Files of pictures that share a camera and extent, so that only the objects differ: side by side, or in a movie.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "apps/render/render.h"
#include "command.h"

namespace pliant::command {

struct Size {
  int width = 0, height = 0;  ///< [pixels]
};

/// Reads "1280x720".
Size parse_size(const std::string& text);

/// What all pictures of a movie or strip share.
struct View {
  render::Camera camera;
  render::Extent extent;

  void apply(render::RenderScene& scene) const {
    scene.camera = camera;
    scene.extent = extent;
  }
};

/// A picture (.png) of as many moments side by side. What it needs to draw is checked when it is made.
class SideBySide {
 public:
  SideBySide(const RenderOptions& options, const Size& size, std::size_t count);
  /// Draws the moments, and writes the file.
  void draw(std::vector<render::RenderScene> moments);

 private:
  const RenderOptions& options_;
  Size size_;
  int panel_;  ///< width of each picture [pixels]
  render::Renderer renderer_;
};

/// A movie (.mp4) of frames that are `frame_time` apart [s].
class Movie {
 public:
  Movie(const RenderOptions& options, const Size& size, double frame_time);
  /// Every how many frames one is shown: a draft has some 15 a second.
  int every() const { return every_; }
  /// Sets the view, which must show these moments.
  void see(const std::vector<render::RenderScene>& moments);
  void add(render::RenderScene picture);
  void finish() { writer_.finish(); }

 private:
  const RenderOptions& options_;
  Size size_;
  int every_;
  render::Renderer renderer_;
  render::MovieWriter writer_;
  View view_;
};

}  // namespace pliant::command
