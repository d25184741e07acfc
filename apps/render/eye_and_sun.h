// Where a picture is seen from, and where its light comes from.
#pragma once

#include <vector>

#include "geometry.h"
#include "matrix.h"
#include "render.h"

namespace pliant::render {

/// The camera and what follows from it.
struct Eye {
  Camera camera;
  ViewFrame frame;
  float half_width = 1, half_height = 1;  // half the picture's size at distance 1
  float near = 0.1f, far = 100;
  Matrix view_projection;
};

Eye make_eye(const Camera& camera, int width, int height, const Extent& extent);

/// The sun, and an orthographic view along its rays in which everything is visible.
struct Sun {
  Vec3f direction{};
  Matrix clip;
  float depth = 1;     // of the shadow map along the rays [m]
  float softness = 0;  // radius of a shadow's soft edge over the distance of what casts it, in units of the shadow map
};

/// `extent` is that of what the picture shows; what is many times as far away casts no shadow.
Sun make_sun(const ViewFrame& view, const std::vector<Geometry>& geometries, const Extent& extent);

}  // namespace pliant::render
