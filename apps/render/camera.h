// Where a picture is seen from.
#pragma once

#include "pliant/io.h"
#include "pliant/vec3.h"

namespace pliant::render {

/// The camera of a picture.
struct Camera {
  Vec3f eye{0, 1, 3};
  Vec3f target{};
  float field_of_view = 30;  ///< vertical angle of view [degrees], 5..120
};

/// What `wanted` leaves open is as in `otherwise`.
SceneCamera merged(const SceneCamera& wanted, const SceneCamera& otherwise);

}  // namespace pliant::render
