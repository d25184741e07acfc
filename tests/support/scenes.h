// Small scenes shared by tests of a World.
#pragma once

#include <string>
#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::testing_support {

/// Free particles of 1 kg.
inline Object loose_particles(std::vector<Vec3f> positions, std::vector<Vec3f> velocities = {}) {
  Object object;
  object.name = "particles";
  object.masses.assign(positions.size(), 1);
  object.positions = std::move(positions);
  object.velocities = std::move(velocities);
  return object;
}

/// A line of particles of 1 kg, `spacing` apart along x from the origin, joined by distance constraints.
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

/// Settings of a plain sweep.
inline Settings settings_of(int substeps, int iterations = 1, int threads = 1) {
  Settings settings;
  settings.sweep = Sweep::tiled;
  settings.substeps = substeps;
  settings.iterations = iterations;
  settings.threads = threads;
  return settings;
}

/// Linear motion by `way` from time 0 to `seconds`.
inline Motion straight(const Vec3f& way, float seconds) {
  return {{Keyframe{0, {}, {}}, Keyframe{seconds, way, {}}}, {}, false};
}

}  // namespace pliant::testing_support
