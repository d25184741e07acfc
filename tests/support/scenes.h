// Small scenes that several tests of a World use.
#pragma once

#include <string>
#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::testing_support {

/// An object of free particles of 1 kg each.
inline Object loose_particles(std::vector<Vec3f> positions, std::vector<Vec3f> velocities = {}) {
  Object object;
  object.name = "particles";
  object.masses.assign(positions.size(), 1);
  object.positions = std::move(positions);
  object.velocities = std::move(velocities);
  return object;
}

/// An object of particles of 1 kg along the x-axis from the origin, `spacing` apart, with distance constraints between
/// neighbours.
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

/// Settings with the tiled sweep.
inline Settings settings_of(int substeps, int iterations = 1, int threads = 1) {
  Settings settings;
  settings.sweep = Sweep::tiled;
  settings.substeps = substeps;
  settings.iterations = iterations;
  settings.threads = threads;
  return settings;
}

/// A motion at constant velocity: by `way` within `seconds`.
inline Motion straight(const Vec3f& way, float seconds) {
  return {{Keyframe{0, {}, {}}, Keyframe{seconds, way, {}}}, {}, false};
}

}  // namespace pliant::testing_support
