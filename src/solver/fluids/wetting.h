// Adhesion of the liquids of a pool to colliders and rigid bodies, by which they meet these at a contact angle
// (WettingLaw of tension_law.h).
//
// A wall counts as a half-space at its nearest point, and several by 1 - product of (1 - W), as in fluid_walls.h. A
// force is minus the gradient of a particle's energy, along the wall's normal; a body gets the opposite at the
// particle's place, so that momentum is kept.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/material.h"
#include "solver/fluids/fluid_walls.h"
#include "solver/fluids/tension_law.h"

namespace pliant {

struct Substep;

/// A wall near a particle.
struct WallPull {
  std::int32_t slot = 0, wall = 0;  ///< the wall as FluidBounds::at() counts
  Vec3f gradient{};                 ///< of W [1/m]
  Vec3f force{};                    ///< on the particle [N]
};

class FluidWetting {
 public:
  /// Adds particles of a liquid, in the order of FluidPool::points.
  void add(const Fluid& fluid, int particles);
  /// Forgets all particles.
  void clear();
  bool has_any() const { return has_any_; }

  /// When neighbours were found: finds the walls within `reach` of each group of slots. `object` is one of the pool's.
  void find(Substep& s, int object, const NeighbourLists& lists, const Records& by_point, float reach);
  /// Finds what walls add to the counts of particles at their places.
  void measure(Substep& s, const NeighbourLists& lists, const Records& places);
  const std::vector<float>& counts() const { return counts_; }  ///< by slot [-]
  /// Adds the pull of walls to the forces on particles, and moves bodies by the opposite. `lacking` is
  /// TensionArrays::lacking.
  void pull(Substep& s, const NeighbourLists& lists, const Records& lacking, const std::vector<float>& tensions,
            Records& forces);

 private:
  void measure_slot(const FluidBounds& bounds, const NearWalls& near, const Record& place, int slot,
                    std::vector<WallPull>& to);
  void pull_bodies(Substep& s, int colliders, const Records& places);

  bool has_any_ = false;
  std::vector<WettingLaw> of_point_;
  int object_ = 0;
  float reach_ = 0;  ///< [m]
  FluidWalls walls_;
  Records found_at_;                          ///< by slot
  std::vector<WettingLaw> of_slot_;           ///< by slot
  std::vector<float> counts_;                 ///< by slot
  std::vector<std::vector<WallPull>> pulls_;  ///< of each task, ascending by slot
  std::vector<Vec3f> moved_, turned_;         ///< of each body
};

}  // namespace pliant
