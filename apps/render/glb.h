// Pictures of .glb files: glTF 2.0 as `pliant run --out NAME.glb` and other programs write it.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "render.h"

namespace pliant::render {

class GlbBytes;

/// A .glb file whose animation can be drawn: meshes, lines and points, their morph targets, and nodes that move. Skins,
/// textures and cameras are left out.
class GlbFile {
 public:
  /// Throws an Error that names the file if it cannot be read, is damaged, or has what this reader does not know.
  explicit GlbFile(const std::string& path);
  ~GlbFile();
  GlbFile(GlbFile&&) noexcept;
  GlbFile& operator=(GlbFile&&) noexcept;

  /// The number of the last frame: a frame for each time at which any channel of the animation has a key, from 0.
  /// 0 if nothing moves.
  int last_frame() const;
  /// Seconds between two frames, on average.
  double frame_time() const;
  /// What to draw of a frame, 0 to last_frame(). Throws as the constructor.
  RenderScene frame(int number) const;

 private:
  struct Channel;
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace pliant::render
