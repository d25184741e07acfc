// The energy that folds store, which a fall puts into them and a rebound gives back.
#pragma once

#include <array>
#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::bench {

/// The elastic energy C^2 / (2 compliance) of a scene's dihedral hinges. Rigid hinges and those with PBD stiffness
/// store none.
class BendingEnergy {
 public:
  explicit BendingEnergy(const Scene& scene);
  /// For a World of that scene, to which nothing was added [J].
  double of(const World& world) const;

 private:
  struct Hinge {
    std::array<std::size_t, 4> particle;
    double rest;       ///< angle [rad]
    double stiffness;  ///< 1 / compliance [N m]
  };
  std::vector<std::vector<Hinge>> hinges_;  ///< of each object
};

}  // namespace pliant::bench
