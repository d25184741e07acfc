// A cube that is torn far out and let back, for tests of what soft bodies bear.
#pragma once

#include <cmath>

#include "pliant/scene.h"
#include "pliant/soft_body.h"

namespace pliant::testing_support {

/// A cube of 0.2 m without gravity, of which one face is held, and the other is pulled away by `way` [m] and back within
/// 0.2 s of its 120 frames.
inline Scene pulled_cube(float way, const ElasticSolid& material) {
  SoftBodyOptions options;
  options.name = material.name;
  options.material = material;
  Object body = make_soft_body(box_tetrahedra({0.2f, 0.2f, 0.2f}, {4, 4, 4}), options);
  Motion motion;
  motion.keyframes = {{0, {}, {}}, {0.1f, {way, 0, 0}, {}}, {0.2f, {}, {}}};
  for (int i = 0; i < static_cast<int>(body.positions.size()); ++i) {
    const float x = body.positions[static_cast<std::size_t>(i)].x;
    if (std::fabs(x) > 0.09f) body.pins.push_back({i, x > 0 ? motion : Motion{}});
  }
  Scene scene;
  scene.add(body);
  scene.gravity = {};
  scene.frames = 120;
  return scene;
}

}  // namespace pliant::testing_support
