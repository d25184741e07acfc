// Scenes that tests of the substep law and of the limit of overstretch share.
#pragma once

#include "support/run.h"
#include "world/run_time_support.h"

namespace pliant::testing_support {

/// A sheet that falls onto a ball from 0.5 m.
inline Object falling_sheet(int n = 24) {
  ClothOptions options;
  options.stretch = Stiffness::compliance(0);
  Object cloth = sheet_at("sheet", {0, 0.7f, 0}, n, 1, options);
  cloth.thickness = 0.01f;
  cloth.self_collision = true;
  return cloth;
}

inline Scene impact(int n = 24) {
  Scene scene;
  scene.add(falling_sheet(n));
  Collider ball;
  ball.shape = Sphere{0.2f};
  scene.add(ball);
  return scene;
}

inline Scene hung(float apart = 0) {
  Scene scene;
  ClothOptions options;
  options.stretch = Stiffness::compliance(0);
  Object cloth = sheet_at("cloth", {}, 20, 1, options);
  cloth.pins = {{0, {}}, {19, apart != 0 ? straight({apart, 0, 0}, 1) : Motion{}}};
  scene.add(cloth);
  return scene;
}

}  // namespace pliant::testing_support
