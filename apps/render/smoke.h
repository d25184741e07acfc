// Smoke as a volume: puffs are summed on a grid, light from the sun is attenuated through the grid, and a ray for each
// pixel is marched through it (Kajiya and Von Herzen 1984), up to what the picture shows so far.
#pragma once

#include <cstdint>
#include <vector>

#include "matrix.h"
#include "render.h"

namespace pliant::render {

/// What rays start from.
struct SmokeView {
  Vec3f eye{};
  ViewFrame frame{};
  float half_width = 1, half_height = 1;  ///< half the picture's size at distance 1
  float near = 0.1f, far = 100;           ///< of the depths
  int width = 0, height = 0;
  Vec3f sun{};  ///< direction to it
};

/// Draws the smoke of a scene over a picture: rows from the top, sRGB. `depths` has rows from the bottom, 0 to 1, as
/// OpenGL has them.
void draw_smoke(const std::vector<RenderSmoke>& smokes, const SmokeView& view, const std::vector<float>& depths,
                std::vector<std::uint8_t>& rgb);

}  // namespace pliant::render
