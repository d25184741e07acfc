// Viscosity of the liquids of a pool: backward Euler in the displacements of a substep, u = u0 - M^-1 h L u, in which L
// is the symmetric operator of pairs of neighbours, walls and bodies. So it is stable for any viscosity and any
// substep.
//
// It acts on displacements within the iterations, before contacts, and not on velocities after them: positions then
// move by the velocities that viscosity leaves, and contact has the last word. Pairs push along their line, so that
// linear and angular momentum are kept, and a liquid turns as a rigid body without resistance. With conjugate gradients
// that are preconditioned by the masses this holds for any number of iterations. Sums have a fixed order.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/report.h"
#include "solver/fluids/viscosity_kernels.h"
#include "solver/fluids/viscosity_walls.h"

namespace pliant {

struct FluidPool;
struct Substep;

class FluidViscosity {
 public:
  /// Adds particles with a viscosity [Pa s], in the order of FluidPool::points.
  void add(float viscosity, int particles);
  /// Forgets all particles.
  void clear();
  bool has_any() const { return has_any_; }

  void begin_frame() { solves_ = {}; }
  /// After the density of an iteration: solves for the displacements of its particles and of the bodies that they
  /// touch. Later iterations of a substep solve again for what they have changed.
  void solve(Substep& s, FluidPool& pool, bool is_first);
  const ViscositySolves& solves() const { return solves_; }

 private:
  /// A body's translation and rotation, or the force and torque on it.
  struct Twist {
    Vec3f linear{}, angular{};
  };
  struct Body {
    Twist motion, impulse;           ///< in the substep; what viscosity has given it so far
    Twist residual, way, direction;  ///< `way` is the inverse mass times `direction`
    Twist force;
    bool is_held = false;  ///< true if a particle grips it
  };

  void gather(Substep& s, const FluidPool& pool, bool is_first);
  void gather_bodies(Substep& s, bool is_first);
  void start(Substep& s, const FluidPool& pool);
  void resist(Substep& s, const FluidPool& pool, const Records& motions, bool with_walls);
  void resist_bodies(const Records& motions, bool with_walls);
  Vec3f slip(const WallGrip& grip, const Record& motion, bool with_walls) const;
  double update(Substep& s, const FluidPool& pool, float step);
  void turn_direction(Substep& s, const FluidPool& pool, float share);
  double work_along(Substep& s, const FluidPool& pool);
  double squared_residual(Substep& s, const FluidPool& pool);
  double sum(double of_bodies) const;
  void scatter(Substep& s, const FluidPool& pool);
  void scatter_bodies(Substep& s);
  ViscosityArrays arrays(const Substep& s, const FluidPool& pool);

  std::vector<float> of_point_;
  bool has_any_ = false, are_alike_ = true;
  ViscositySolves solves_;
  ViscosityWalls walls_;
  // By slot:
  std::vector<float> viscosities_, masses_, inverse_masses_;  ///< 0 for those that are fixed
  Records motions_, before_, impulses_;  ///< displacements; those before the solve; what viscosity has added [m]
  Records residuals_, directions_, forces_;
  std::vector<double> parts_;  ///< of sums, by group
  std::vector<Body> bodies_;   ///< all touched bodies; empty without any
  std::vector<Twist> bodies_before_;
};

}  // namespace pliant
