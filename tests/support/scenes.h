// Small scenes that tests of a World share.
#pragma once

#include <string>
#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::testing_support {

/// Particles of 1 kg and nothing between them.
inline Object loose_particles(std::vector<Vec3f> positions, std::vector<Vec3f> velocities = {}) {
  Object object;
  object.name = "particles";
  object.masses.assign(positions.size(), 1);
  object.positions = std::move(positions);
  object.velocities = std::move(velocities);
  return object;
}

/// A line of particles of 1 kg, `spacing` apart along x from the origin, joined by distances.
inline Object chain(int particles, float spacing, const Stiffness& stiffness = {}) {
  Object object;
  object.name = "chain";
  ConstraintGroup links{"distance", {}, {}, stiffness, {}};
  for (int i = 0; i < particles; ++i) {
    object.positions.push_back({static_cast<float>(i) * spacing, 0, 0});
    object.masses.push_back(1);
    if (i > 0) links.particles.insert(links.particles.end(), {i - 1, i});
  }
  object.constraints = {links};
  return object;
}

/// Of plain sweeps.
inline Settings settings_of(int substeps, int iterations = 1, int threads = 1) {
  Settings settings;
  settings.sweep = Sweep::tiled;
  settings.substeps = substeps;
  settings.iterations = iterations;
  settings.threads = threads;
  return settings;
}

/// Straight from one place to another, from time 0 to `seconds`.
inline Motion straight(const Vec3f& way, float seconds) {
  return {{Keyframe{0, {}, {}}, Keyframe{seconds, way, {}}}, {}, false};
}

}  // namespace pliant::testing_support
