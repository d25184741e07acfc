// Surface tension of the liquids of a pool: forces that are minus the gradient of a surface energy (tension_law.h), at
// predicted places. That takes hardly any energy from oscillations of drops, but damps the fast ones, which forces at
// the places where a substep starts would feed: with those, drops burst. Where a substep is too long even so, less
// tension acts. Walls attract by wetting.h.
#pragma once

#include <vector>

#include "collision/neighbours/neighbour_lists.h"
#include "pliant/report.h"
#include "solver/fluids/tension_kernels.h"
#include "solver/fluids/wetting.h"

namespace pliant {

struct FluidPool;
struct Substep;

class FluidTension {
 public:
  /// Adds particles of a liquid, in the order of FluidPool::points.
  void add(const Fluid& fluid, int particles);
  /// Forgets all particles.
  void clear();
  bool has_any() const { return has_any_; }

  void begin_frame() { acts_ = {}; }
  /// When the pool has found its neighbours: finds those of surface tension, which acts farther. `by_point` are
  /// predicted places.
  void find_neighbours(Substep& s, const FluidPool& pool, const Records& by_point);
  /// After the prediction: adds what forces move particles in the substep.
  void act(Substep& s, const FluidPool& pool);
  const TensionActs& acts() const { return acts_; }

 private:
  void gather(Substep& s, const FluidPool& pool);
  void move(Substep& s, const FluidPool& pool);

  TensionLaw law_{};
  std::vector<float> of_point_, masses_;  ///< [N/m], [kg]
  bool has_any_ = false;
  TensionActs acts_;
  NeighbourLists neighbours_;
  Records places_, lacking_, forces_;  ///< by slot
  std::vector<float> tensions_;        ///< by slot
  FluidWetting wetting_;
};

}  // namespace pliant
