// Grids of particles with every kind of constraint, for tests of compiled objects.
#pragma once

#include <algorithm>
#include <iterator>
#include <limits>
#include <random>
#include <vector>

#include "model/compiled_object.h"

namespace pliant {

/// A crumpled grid with edges, hinges of both types with every law, pins and attachments.
inline Object rumpled_grid(int columns, int rows) {
  Object object;
  object.name = "grid";
  std::mt19937 random(11);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const float bump = static_cast<float>(random() % 1000) * 1e-4f;
      object.positions.push_back({static_cast<float>(c) * 0.1f, bump, static_cast<float>(r) * 0.1f});
      object.masses.push_back(0.5f + bump);
      object.velocities.push_back({bump, 0, -bump});
    }
  }
  object.masses[1] = std::numeric_limits<float>::infinity();
  const auto at = [&](int r, int c) { return r * columns + c; };
  ConstraintGroup edges{"distance", {}, {}, Stiffness::compliance(1e-6f), {}},
      pbd{"distance", {}, {}, Stiffness::pbd(0.9f), {}};
  ConstraintGroup damped{"distance", {}, {}, Stiffness::compliance(1e-5f, 2), {}};
  ConstraintGroup hinges{"dihedral_bending", {}, {}, Stiffness::compliance(0.1f), {}};
  ConstraintGroup isometric{"isometric_bending", {}, {}, Stiffness::compliance(0.2f), {}};
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      if (c + 1 < columns) edges.particles.insert(edges.particles.end(), {at(r, c + 1), at(r, c)});
      if (r + 1 < rows) pbd.particles.insert(pbd.particles.end(), {at(r, c), at(r + 1, c)});
      if (r + 1 < rows && c + 1 < columns) {
        damped.particles.insert(damped.particles.end(), {at(r, c), at(r + 1, c + 1)});
        hinges.particles.insert(hinges.particles.end(), {at(r + 1, c + 1), at(r, c), at(r, c + 1), at(r + 1, c)});
        isometric.particles.insert(isometric.particles.end(), {at(r, c), at(r + 1, c + 1), at(r + 1, c), at(r, c + 1)});
        object.triangles.push_back({at(r, c), at(r + 1, c + 1), at(r, c + 1)});
        object.triangles.push_back({at(r, c), at(r + 1, c), at(r + 1, c + 1)});
      }
    }
  }
  object.constraints = {edges, hinges, pbd, isometric, damped};
  object.pins.push_back({0, Motion{{Keyframe{0, {0, 0, 0}, {}}, Keyframe{1, {1, 0, 0}, {}}}, {}, false}});
  object.attachments.push_back({columns - 1, {5, 5, 5}, {}, Stiffness::compliance(1e-3f)});
  return object;
}

inline std::vector<ObjectPhase> phases_of(const CompiledObject& object, Driver driver) {
  std::vector<ObjectPhase> phases;
  std::copy_if(object.phases.begin(), object.phases.end(), std::back_inserter(phases),
               [&](const ObjectPhase& phase) { return phase.driver == driver; });
  return phases;
}

}  // namespace pliant
