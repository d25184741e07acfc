// Scenes and settings that tests of advice share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "pliant/advise.h"
#include "support/scenes.h"

namespace pliant {
namespace testing_support {

constexpr float dt = 1.f / 60;
const AdviseOptions unhurried{1e6, 120, {}};

/// A weight of 1 kg that hangs on a pin by one link of 1 m.
inline Scene weight_on(const Stiffness& stiffness) {
  Scene scene;
  Object object = chain(2, 1, stiffness);
  object.positions[1] = {0, -1, 0};
  object.pins = {{0, {}}};
  scene.add(object);
  return scene;
}

inline Scene hanging_sheet(int n, const Stiffness& stretch, int substeps) {
  Scene scene;
  ClothOptions options;
  options.name = "sheet";
  options.stretch = stretch;
  scene.add_cloth(grid_mesh(n, n, 1, 1), options);
  scene.pin(0, {0, n - 1});
  scene.settings = settings_of(substeps);
  scene.frames = 30;
  return scene;
}

/// The same with the default, which several iterations make a poor one: 20 substeps of `tiled`.
inline Scene poor_by_default(Scene scene) {
  scene.settings = settings_of(0, 2);
  scene.settings.sweep = Sweep::automatic;
  return scene;
}

inline bool is_default(const Trial& trial) {
  return trial.settings.sweep == Sweep::automatic && trial.settings.substeps == 0;
}

/// The largest stretch of any frame, measured otherwise than in a trial.
inline double largest_stretch(const Scene& scene, const Settings& settings) {
  World world(scene, settings);
  double largest = 1;
  for (int frame = 0; frame < scene.frames; ++frame) {
    world.step(scene.frame_time);
    largest = std::max(largest, world.measure().stretch().largest);
  }
  return largest;
}

}  // namespace testing_support
}  // namespace pliant
