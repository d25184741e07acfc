// The share of colliders in the density of a liquid: what the kernel of a particle loses where a wall cuts it off.
//
// A wall counts as a half-space at its nearest point, for which the integral of the kernel is exact; several count by 1 - product of
// (1 - share), which in a corner is within 2 % of a lattice that goes on behind the walls. Contacts keep particles out; the density only keeps
// them from gathering at walls.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/narrow/contact.h"
#include "collision/neighbours/neighbour_lists.h"
#include "parallel/executor.h"
#include "solver/fluids/fluid_law.h"

namespace pliant {

class FluidWalls {
 public:
  /// Finds the colliders near each group of slots, for as long as no point moves farther than `motion` [m] against them.
  void find(const CompiledObject& liquid, const NeighbourLists& lists, const Records& places,
            const std::vector<MovingCollider>& colliders, float reach, float motion);
  /// Measures the share of colliders at the present places of a group's slots.
  void measure(const FluidLaw& law, const std::vector<MovingCollider>& colliders, const Records& places, int group);

  const Records& shares() const { return shares_; }  ///< by slot: see FluidArrays::walls
  const std::vector<char>& has_any() const { return has_any_; }

 private:
  std::vector<std::int32_t> begin_, near_;  ///< of each group: indices of colliders
  std::vector<char> has_any_;               ///< [group]
  Records shares_;
};

}  // namespace pliant
