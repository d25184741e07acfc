// Vorticity confinement of the liquids of a pool (Macklin and Mueller 2013, eq. 15 and 16): an acceleration that gives
// swirls back what the density constraint damps. It changes slowly, so it acts every few substeps and at the end of a
// frame, as that of gases does.
//
// The accelerations of a swirl's sides differ a little, so their sum would push the liquid. Each particle gives back
// its share of that sum, in proportion to its own acceleration, so that the pool keeps its momentum, and liquid without
// swirls is not moved.
#pragma once

#include <vector>

#include "parallel/executor.h"
#include "pliant/state.h"

namespace pliant {

struct FluidPool;
struct Substep;

class FluidVorticity {
 public:
  /// Adds particles with a coefficient [m/s], in the order of FluidPool::points.
  void add(float coefficient, int particles);
  /// Forgets all particles.
  void clear();

  void begin_frame();
  /// After the update. `gravity(object)` is the part of gravity that velocities do not include yet [m/s].
  void respond(Substep& s, const FluidPool& pool, FunctionRef<Vec3f(int)> gravity);

 private:
  /// The momentum that a group gains, and the sum of its magnitudes [kg m/s].
  struct Part {
    Vec3d momentum{};
    double magnitude = 0;
  };

  void load(Substep& s, const FluidPool& pool, FunctionRef<Vec3f(int)> gravity);
  void measure(const FluidPool& pool, int slot);
  Vec3f gain(const FluidPool& pool, int slot) const;
  void find_gains(Substep& s, const FluidPool& pool);
  Vec3f surplus() const;

  bool has_any_ = false;
  std::vector<float> of_point_;
  int substeps_ = 0;   ///< since it has acted
  float seconds_ = 0;  ///< likewise
  // By slot:
  Records places_, velocities_;
  Records vorticities_;      ///< and in w their size [1/s]
  Records gains_;            ///< of velocity, and in w their size [m/s]
  std::vector<Part> parts_;  ///< by group
};

}  // namespace pliant
