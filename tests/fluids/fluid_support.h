// What the tests of liquids share.
#pragma once

#include "math/vector.h"
#include "pliant/scene.h"

namespace pliant::testing_support {

inline Vec3d in_double(const Vec3f& a) { return {a.x, a.y, a.z}; }

/// A scene of one object without gravity, on one thread.
inline Scene weightless(const Object& object, int substeps) {
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  scene.add(object);
  return scene;
}

}  // namespace pliant::testing_support
