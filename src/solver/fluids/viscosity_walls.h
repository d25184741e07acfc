// Where a viscous liquid is near colliders and rigid bodies, which hold it: no slip.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/fluids/fluid_bodies.h"
#include "solver/fluids/fluid_walls.h"
#include "solver/fluids/viscosity_law.h"

namespace pliant {

struct Substep;

/// A particle that a wall holds.
struct WallGrip {
  std::int32_t slot = 0;
  std::int32_t body = -1;  ///< among the touched bodies; -1: a collider
  float factor = 0;        ///< resistance to motion along the wall, times the substep [kg]
  Vec3f normal{};
  Vec3f motion{};  ///< of a collider in the substep [m]
  Vec3f arm{};     ///< from the body's centre of mass to the particle [m]

  /// The part of a motion along the wall.
  Vec3f along(const Vec3f& way) const { return way - normal * dot(normal, way); }
};

/// The grips of a group of slots, in the order of slots.
struct GripRange {
  const WallGrip *first = nullptr, *last = nullptr;
  const WallGrip* begin() const { return first; }
  const WallGrip* end() const { return last; }
};

class ViscosityWalls {
 public:
  /// Finds the grips on all particles at their places. Viscosities are by slot, of slots behind the last one too.
  void find(Substep& s, const ViscosityLaw& law, const FluidWalls& walls, const FluidBounds& bounds,
            const Records& places, const std::vector<float>& viscosities, int slots);

  GripRange of_group(int group) const;
  /// Those by bodies, which are in this order in all groups.
  const std::vector<WallGrip>& all() const { return grips_; }

 private:
  std::vector<WallGrip> grips_;
  std::vector<std::size_t> begin_;  ///< of each group
};

}  // namespace pliant
