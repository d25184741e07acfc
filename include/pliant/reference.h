// A reference solver for tests: PBD in double precision, constraints in the order in which they were added, in the
// simplest possible code. It is slow, and serves for verification only.
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

/// A particle. Inverse mass 0 makes it a pin, which moves only if you set `position` between steps.
struct Particle {
  Vec3d position{};         ///< position of the particle [m]
  Vec3d velocity{};         ///< velocity of the particle [m/s]
  double inverse_mass = 1;  ///< inverse mass >= 0 [1/kg]
};

/// The stiffness of a constraint: compliance with damping, or PBD stiffness if that is not negative.
struct Hardness {
  double compliance = 0;  ///< compliance alpha >= 0 [m/N for a distance]
  double damping = 0;     ///< damping coefficient beta >= 0 [N s/m for a distance]
  double pbd = -1;        ///< PBD stiffness k in [0, 1]; negative: use compliance
};

/// The value C of a constraint and its gradients, one for each particle.
struct Evaluation {
  double value = 0;
  std::vector<Vec3d> gradients;
};

/// Evaluates a constraint type at the positions `x` of its particles [m]. Throws an Error if constraint_types() has no
/// such type, or if `x` or the rest data have the wrong size.
Evaluation evaluate(const std::string& type, const std::vector<Vec3d>& x, const std::vector<double>& rest);

/// The rest data that make these positions the rest shape. Throws as evaluate does.
std::vector<double> measure(const std::string& type, const std::vector<Vec3d>& x);

class AnyConstraint;

/// A system of particles and constraints, and the loop that solves it.
class Solver {
 public:
  /// Acceleration of gravity [m/s^2]
  Vec3d gravity{};
  double damping = 0;  ///< rate at which velocities decay: by a factor exp(-damping) per second [1/s]
  int substeps = 1;    ///< substeps per step, >= 1
  int iterations = 1;  ///< iterations per substep, >= 1
  std::vector<Particle> particles;

  Solver();
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  /// Adds a particle and returns its index. `mass` is > 0, or infinity for a pin [kg].
  int add(const Vec3d& position, double mass, const Vec3d& velocity = {});

  /// Adds a constraint and returns its index. Empty rest data are measured from the positions. Throws an Error for a
  /// type not in constraint_types(), a missing particle, or particles or rest data of the wrong number.
  int add(const std::string& type, const std::vector<int>& particles, const std::vector<double>& rest = {},
          const Hardness& hardness = {});

  int constraint_count() const { return static_cast<int>(constraints_.size()); }
  /// The current value of C of the constraint with this index.
  double value(int constraint) const;
  /// The multiplier of the last substep [kg m^2 / unit of C]; the force is multiplier / h^2 along the gradient.
  double multiplier(int constraint) const;

  /// Advances all particles by dt > 0 [s].
  void step(double dt);

  double kinetic_energy() const;    ///< kinetic energy of all particles except pins [J]
  double potential_energy() const;  ///< gravitational energy relative to the origin [J]

 private:
  void substep(double h);

  std::vector<std::unique_ptr<AnyConstraint>> constraints_;
};

}  // namespace pliant::reference
