// What gases do beyond liquids, as stages of a frame: the air around bears them up and brakes them, heat diffuses and
// is lost, vorticity is confined, and tracers go along (Macklin, Mueller, Chentanez and Kim 2014, section 7). Density
// is that of FluidSolver.
//
// Buoyancy acts in each substep. All else changes slowly, and acts every few substeps and at the end of a frame.
#pragma once

#include <string_view>
#include <vector>

#include "model/model.h"
#include "parallel/executor.h"
#include "solver/fluids/fluid_solver.h"

namespace pliant {

struct Substep;

/// A particle of a pool that gases share, at the substep's end.
struct GasPoint {
  Vec3f place{}, velocity{};  ///< [m], [m/s]
  float temperature = 0;      ///< [K]
  const Gas* gas = nullptr;   ///< null: it is of a liquid
};

/// What a pass over the neighbours of a particle finds.
struct GasChange {
  Vec3f vorticity{};  ///< [1/s]
  float vorticity_size = 0;
  float heat = 0;  ///< Laplacian of the temperature [K/m^2]
};

/// The particles of a pool by slot, for a pass.
struct GasPass {
  const FluidPool* pool = nullptr;
  float largest_rate = 0;  ///< of diffusion: more would make it unstable [m^2]
  std::vector<GasPoint> points;
  std::vector<GasChange> changes;
};

class GasSolver : public System {
 public:
  /// For the gases, tracers and balloons of the given objects, or of all if it is null. `fluids` has the pools of gases;
  /// null: there are none.
  GasSolver(const Model& model, const std::vector<int>* objects, const FluidSolver* fluids);
  ~GasSolver() override;

  bool has_any() const { return !gases_.empty() || !tracers_.empty() || !balloons_.empty(); }

  void begin_frame(Substep& s) override;
  /// Buoyancy of gases; tracers have no weight.
  void apply_forces(Substep& s) override;
  /// All else, every few substeps.
  void respond(Substep& s, FunctionRef<Vec3f(int)> gravity) override;
  bool changes_velocities() const override { return true; }

 private:
  void begin_pass();
  void load(Substep& s, GasPass& pass, FunctionRef<Vec3f(int)> gravity) const;
  void change(Substep& s, GasPass& pass, float seconds) const;
  void store(Substep& s, const GasPass& pass, FunctionRef<Vec3f(int)> gravity) const;

  const FluidSolver* fluids_ = nullptr;
  std::vector<int> gases_, tracers_, balloons_;  ///< objects, ascending; of the last, closed surfaces that hold gas
  std::vector<GasPass> passes_;                  ///< of pools with gases
  double last_pass_ = -1;                        ///< when it was; -1: none in this frame [s]
  int substeps_ = 0;                             ///< since the last pass
  float seconds_ = 0;                            ///< likewise
};

/// The channel of a name in a State that has it.
std::vector<float>& channel_of(State& state, std::string_view name);

}  // namespace pliant
