// Where a picture is seen from.
#pragma once

#include <optional>

#include "pliant/vec3.h"

namespace pliant::render {

/// The camera of a picture.
struct Camera {
  Vec3f eye{0, 1, 3};
  Vec3f target{};
  float field_of_view = 30;  ///< vertical angle of view [degrees], 5..120
};

/// What is asked of a camera. By default it is at the front, to the right and above, and shows the bulk of everything.
struct CameraOptions {
  float azimuth = 28;               ///< angle about the vertical from the front to the right [degrees]
  float elevation = 18;             ///< angle above the horizon, -89..89 [degrees]
  float field_of_view = 30;         ///< vertical angle of view, 5..120 [degrees]
  std::optional<Vec3f> look_at{};   ///< the point in the middle of the picture [m]; none: the middle of the scenes
  std::optional<float> distance{};  ///< from that point, above 0 [m]; none: so that the scenes fill the picture
};

}  // namespace pliant::render
