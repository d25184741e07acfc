// What a liquid pushes rigid bodies: each particle whose density a solid has a share in pushes the body back by its
// multiplier, at its own place, so that particles and bodies together keep their momentum. Hydrostatic pressure, and so
// buoyancy, is the sum of these pushes.
//
// All particles push at the same time. A body that many touch is divided among them (mass splitting, Tonge,
// Benevolenski and Voroshilov
// 2012), so that light bodies are not pushed too far.
#pragma once

#include <vector>

#include "solver/fluids/fluid_walls.h"

namespace pliant {

struct Substep;

class FluidBodies {
 public:
  /// The colliders and bodies that bound an object's liquid in the present substep.
  static FluidBounds bounds(const Substep& s, int object);
  /// The present centre of mass of one of BodySolver::touched_bodies().
  static Vec3f centre_of(const Substep& s, int body);

  /// After the walls are measured: counts the slots that touch each body.
  void count(const Substep& s, const FluidWalls& walls);
  /// Sets for each slot of a group what the bodies near it add to the squared gradients of its density [1/m^2]. `mass`
  /// is that of a particle of the lightest liquid [kg].
  void add_squares(const Substep& s, const FluidWalls& walls, const Records& places, float mass, int group,
                   std::vector<float>& squares) const;
  /// After the multipliers: moves and turns the bodies. `weighted` is FluidArrays::weighted.
  void push(Substep& s, const FluidWalls& walls, const Records& weighted, const std::vector<float>& lightness,
            float mass);

 private:
  /// [body]
  std::vector<int> touched_;
  std::vector<Vec3f> moved_, turned_;
};

}  // namespace pliant
