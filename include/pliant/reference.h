// A second solver to hold the first against: position based dynamics in double precision, one constraint after another in the
// order in which they were added, in the plainest code that does it. Slow, and for checking only.
//
// It shares the formulas of the constraint types with World, and nothing of World's schedule, layout, lanes or rounding.
// Mueller et al. 2007 for stiffness k; Macklin, Mueller and Chentanez 2016 for compliance and damping; Macklin et al. 2019 for
// substeps.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "pliant/vec3.h"

namespace pliant::reference {

/// A point of matter. With inverse mass 0 it is a pin: it moves only where `position` is set between steps.
struct Particle {
  Vec3d position{};         ///< [m]
  Vec3d velocity{};         ///< [m/s]
  double inverse_mass = 1;  ///< [1/kg], >= 0
};

/// Compliance alpha with damping beta, or PBD's k where that is not negative.
struct Hardness {
  double compliance = 0;  ///< alpha >= 0 [the type's own unit]
  double damping = 0;     ///< beta >= 0 [N s/m for a distance]
  double pbd = -1;        ///< k in [0, 1]; negative: compliance counts
};

/// A constraint function and its gradients, one a particle of its stencil.
struct Evaluation {
  double value = 0;
  std::vector<Vec3d> gradients;
};

/// C of a type of constraint_types() at the places `x` of its stencil [m]. Throws Error for an unknown type, or a stencil or rest
/// data of the wrong size.
Evaluation evaluate(const std::string& type, const std::vector<Vec3d>& x, const std::vector<double>& rest);

/// The rest data that make these places the rest shape. Throws Error as evaluate does.
std::vector<double> measure(const std::string& type, const std::vector<Vec3d>& x);

class AnyConstraint;

/// Particles and constraints, and the loop over them.
class Solver {
 public:
  Vec3d gravity{};     ///< [m/s^2]
  double damping = 0;  ///< a second keeps the share exp(-damping) of velocity [1/s]
  int substeps = 1;    ///< >= 1
  int iterations = 1;  ///< a substep, >= 1
  std::vector<Particle> particles;

  Solver();
  ~Solver();
  Solver(Solver&&) noexcept;
  Solver& operator=(Solver&&) noexcept;

  /// Adds a particle (mass > 0, or infinity for a pin [kg]) and returns its index.
  int add(const Vec3d& position, double mass, const Vec3d& velocity = {});

  /// Adds a constraint of a type of constraint_types() and returns its index. Empty rest data are measured from the particles'
  /// places. Throws Error for an unknown type, a particle that does not exist, or a stencil or rest data of the wrong size.
  int add(const std::string& type, const std::vector<int>& particles, const std::vector<double>& rest = {},
          const Hardness& hardness = {});

  int constraint_count() const { return static_cast<int>(constraints_.size()); }
  /// C now. `constraint` is an index that add returned.
  double value(int constraint) const;
  /// Of the last substep; the force is multiplier / h^2 along the gradient [unit of C times kg m^2].
  double multiplier(int constraint) const;

  /// Advances by dt > 0 [s].
  void step(double dt);

  double kinetic_energy() const;    ///< of all particles but pins [J]
  double potential_energy() const;  ///< of their weight, from the origin [J]

 private:
  void substep(double h);

  std::vector<std::unique_ptr<AnyConstraint>> constraints_;
};

}  // namespace pliant::reference
