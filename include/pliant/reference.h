// A reference solver for tests: PBD in double precision, constraints in the order in which they were added, in the simplest
// possible code. It is slow, and for verification only.
//
// It shares the formulas of the constraint types with World, but not World's schedule,
// layout, SIMD lanes or rounding. Stiffness k: Mueller et al. 2007; compliance and
// damping: Macklin, Mueller and Chentanez 2016; substeps: Macklin et al. 2019.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "pliant/vec3.h"

namespace pliant::reference {

/// A particle. With inverse mass 0 it is a pin: it moves only if `position` is set between steps.
struct Particle {
  Vec3d position{};         ///< [m]
  Vec3d velocity{};         ///< [m/s]
  double inverse_mass = 1;  ///< [1/kg], >= 0
};

/// Compliance alpha with damping beta, or PBD's k if it is not negative.
struct Hardness {
  double compliance = 0;  ///< alpha >= 0 [the type's own unit]
  double damping = 0;     ///< beta >= 0 [N s/m for a distance]
  double pbd = -1;        ///< k in [0, 1]; negative: use compliance
};

/// A constraint function and its gradients, one per particle of its stencil.
struct Evaluation {
  double value = 0;
  std::vector<Vec3d> gradients;
};

/// C of a type of constraint_types() at the stencil's positions `x` [m]. Throws an Error for an unknown type, or if the
/// stencil or the rest data have the wrong size.
Evaluation evaluate(const std::string& type, const std::vector<Vec3d>& x, const std::vector<double>& rest);

/// The rest data for which these positions are the rest shape. Throws as evaluate does.
std::vector<double> measure(const std::string& type, const std::vector<Vec3d>& x);

class AnyConstraint;

/// Particles, constraints, and the solver loop.
class Solver {
 public:
  Vec3d gravity{};     ///< [m/s^2]
  double damping = 0;  ///< velocity is multiplied by exp(-damping) per second [1/s]
  int substeps = 1;    ///< >= 1
  int iterations = 1;  ///< iterations per substep, >= 1
  std::vector<Particle> particles;

  Solver();
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  /// Adds a particle (mass > 0, or infinity for a pin [kg]) and returns its index.
  int add(const Vec3d& position, double mass, const Vec3d& velocity = {});

  /// Adds a constraint of a type of constraint_types() and returns its index. Empty rest data are measured from the
  /// positions. Throws an Error for an unknown type, a missing particle, or a stencil or rest data of the wrong size.
  int add(const std::string& type, const std::vector<int>& particles, const std::vector<double>& rest = {},
          const Hardness& hardness = {});

  int constraint_count() const { return static_cast<int>(constraints_.size()); }
  /// The current C. `constraint` is an index returned by add.
  double value(int constraint) const;
  /// The multiplier of the last substep; the force is multiplier / h^2 along the gradient [unit of C times kg m^2].
  double multiplier(int constraint) const;

  /// Advances by dt > 0 [s].
  void step(double dt);

  double kinetic_energy() const;    ///< kinetic energy of all particles except pins [J]
  double potential_energy() const;  ///< gravitational, relative to the origin [J]

 private:
  void substep(double h);

  std::vector<std::unique_ptr<AnyConstraint>> constraints_;
};

}  // namespace pliant::reference
