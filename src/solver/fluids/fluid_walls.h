// The share of colliders in the density of a liquid: what the kernel of a particle loses where a wall cuts it off.
//
// A wall counts as a half-space at its nearest point, for which the integral of the kernel is exact; several count by 1
// - product of (1 - share), which in a corner is within 2 % of a lattice that goes on behind the walls. Contacts keep
// particles out; the density only keeps them from gathering at walls. The solids of rigid bodies count as colliders do;
// FluidBodies passes on what the liquid pushes them.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/narrow/contact.h"
#include "collision/neighbours/neighbour_lists.h"
#include "parallel/executor.h"
#include "solver/fluids/fluid_kernels.h"
#include "solver/fluids/fluid_law.h"

namespace pliant {

/// What bounds a liquid.
struct FluidBounds {
  const std::vector<MovingCollider>* colliders = nullptr;
  const std::vector<MovingCollider>* solids = nullptr;  ///< of rigid bodies; null if there are none
  std::vector<char> meets;                              ///< for each solid, 1 if it touches the liquid

  int number_of_colliders() const { return static_cast<int>(colliders->size()); }
  int number_of_solids() const { return solids == nullptr ? 0 : static_cast<int>(solids->size()); }
  const MovingCollider& at(std::int32_t i) const;
};

/// A solid near a group of slots.
struct NearSolid {
  std::int32_t group = 0, solid = 0;
  int touched = 0;                             ///< slots in whose kernels the solid is
  Vec3f gradient[NeighbourLists::lanes] = {};  ///< of the solid's share in the density of each slot [1/m]
};

/// What a collider or solid has in the gradient of a particle's density.
struct WallGradient {
  std::int32_t which = 0;  ///< as FluidBounds::at() counts
  Vec3f gradient{};        ///< [1/m]
};

/// The distance from a place to a collider at the substep's end, and its normal in world axes.
SurfaceDistance<float> distance_to(const MovingCollider& collider, const Vec3f& place);

/// The colliders and solids near a group of slots: [first, last), as FluidBounds::at() counts.
struct NearWalls {
  const std::int32_t *first = nullptr, *last = nullptr;
};

class FluidWalls {
 public:
  /// Finds what is near each group of slots, for as long as no point moves farther than `motion` [m] against it.
  void find(Executor& executor, const CompiledObject& liquid, const NeighbourLists& lists, const Records& places,
            const FluidBounds& bounds, float reach, float motion);
  /// Measures the share of colliders and solids at the present places of a group's slots.
  void measure(const FluidKernels& kernels, const FluidLaw& law, const FluidBounds& bounds, const Records& places,
               int group);

  /// The gradient of each wall at the place of a slot of the group, as measure() sums them.
  std::vector<WallGradient> gradients(const FluidLaw& law, const FluidBounds& bounds, const Vec3f& place,
                                      int group) const;

  const Records& shares() const { return shares_; }  ///< by slot: see FluidArrays::walls
  const std::vector<char>& has_any() const { return has_any_; }
  NearWalls near(int group) const {
    const auto g = static_cast<std::size_t>(group);
    return {near_.data() + begin_[g], near_.data() + begin_[g + 1]};
  }
  /// In the order of groups; those of a group are [first_solid(group), first_solid(group + 1)).
  const std::vector<NearSolid>& near_solids() const { return near_solids_; }
  int first_solid(int group) const { return first_solid_[static_cast<std::size_t>(group)]; }

 private:
  /// What is near the groups of a task, one behind another.
  struct Found {
    std::vector<std::int32_t> near;
    std::vector<std::int32_t> last;  ///< of each group: the end of its part of `near`
  };

  void find_in_task(const CompiledObject& liquid, const NeighbourLists& lists, const Records& places,
                    const FluidBounds& bounds, float distance, int task);
  void measure_one_by_one(const FluidLaw& law, const FluidBounds& bounds, const Records& places, int group);

  std::vector<Found> found_;                ///< [task]
  std::vector<std::int32_t> begin_, near_;  ///< of each group: indices of colliders, then of solids behind them
  std::vector<char> has_any_;               ///< [group]
  std::vector<int> first_solid_;            ///< [group]
  std::vector<NearSolid> near_solids_;
  Records shares_;
};

}  // namespace pliant
