// The liquids of a substep group, as stages of a frame: their neighbours are found every few substeps, and each
// iteration projects the density constraint of every particle once (Macklin and Mueller 2013), with the small steps of
// Macklin et al. 2019.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "collision/neighbours/neighbour_lists.h"
#include "model/model.h"
#include "pliant/report.h"
#include "solver/fluids/fluid_bodies.h"
#include "solver/fluids/fluid_overlaps.h"
#include "solver/fluids/fluid_walls.h"
#include "solver/fluids/tension.h"
#include "solver/fluids/viscosity.h"
#include "solver/fluids/vorticity.h"
#include "solver/systems/system.h"

namespace pliant {

struct Substep;

/// A place where nobody is near [m].
inline constexpr float nowhere = 1e18f;

/// Liquids with one spacing that mix. Particles are numbered by slots, in the order of cells.
struct FluidPool {
  std::vector<int> objects;  ///< ascending
  FluidLaw law;
  float softness = 0;                 ///< compliance [s^2/m^2]
  std::vector<std::int32_t> points;   ///< all particles that are there, as in the State
  std::vector<std::int32_t> ends;     ///< of each object: where its particles end in `points`
  std::vector<std::int32_t> of_slot;  ///< the particle of each slot
  NeighbourLists neighbours;
  FluidWalls walls;
  FluidBodies bodies;
  FluidViscosity viscosity;
  FluidTension tension;
  FluidVorticity vorticity;
  FluidOverlaps overlaps;
  float mass = 0;                             ///< of a particle of the lightest liquid [kg]; 0 if all are fixed
  std::vector<float> squares;                 ///< by slot: what bodies add to the squared gradients [1/m^2]
  std::vector<float> lightness_of_point;      ///< the least density over that of each point; empty if all have one
  std::vector<float> lightness;               ///< the same by slot, 0 for a fixed particle; empty if all are 1
  Records places, weighted;                   ///< by slot
  std::vector<float> multipliers, densities;  ///< by slot
  int age = -1;                               ///< substeps since neighbours were found; -1: they must be
};

class FluidSolver : public System {
 public:
  /// For the liquids of the given objects, or of all if it is null. Those of different sets (solver/near_sets.h) have
  /// pools of their own; null: all are of one set.
  FluidSolver(const Model& model, const std::vector<int>* objects, const std::vector<int>* sets = nullptr);
  ~FluidSolver() override;

  bool has_any() const { return !pools_.empty(); }

  /// Starts a frame: neighbours are found in its first substep, so that they follow from the State.
  void begin_frame(Substep& s) override;
  /// After the prediction: finds neighbours, if those known are too old, and adds surface tension.
  void collide(Substep& s) override;
  /// Projects all density constraints once.
  void project_neighbours(Substep& s, bool is_first) override;
  /// Vorticity confinement.
  void respond(Substep& s, FunctionRef<Vec3f(int)> gravity) override;
  /// Compression, of several groups the worst, and the solves of viscosity and tension.
  void report(Report& report) const override;

  /// Of the last projection.
  Compression compression() const;
  /// Of all pools in this frame.
  ViscositySolves viscosity() const;
  TensionActs tension() const;
  const std::vector<std::unique_ptr<FluidPool>>& pools() const { return pools_; }

 private:
  static void list_points(const Model& model, const State& state, FluidPool& pool);
  void find_neighbours(Substep& s, FluidPool& pool);
  void find_lightness(const State& state, FluidPool& pool) const;
  void project_pool(Substep& s, FluidPool& pool, bool is_first);

  std::vector<std::unique_ptr<FluidPool>> pools_;
};

}  // namespace pliant
