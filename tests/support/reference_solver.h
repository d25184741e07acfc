// The oracle of the tests: position based dynamics in double precision, one constraint after another in the order in which
// they were added, in the plainest code that does it. It shares with the engine only the formulas of src/constraints (each
// checked on its own by a gradient test) and nothing of its schedule, layout, lanes or rounding.
//
// Mueller et al. 2007 for stiffness k, Macklin, Mueller and Chentanez 2016 for compliance and damping, Macklin et al. 2019
// for substeps. A particle without mass (inverse mass 0) is a pin; move it by setting its position between steps.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "pliant/vec3.h"

namespace pliant::reference {

/// A point of matter.
struct Particle {
  Vec3d position{};         ///< [m]
  Vec3d velocity{};         ///< [m/s]
  double inverse_mass = 1;  ///< [1/kg]; 0: it moves only where it is put
};

/// How stiff a constraint is: compliance alpha with damping beta, or PBD's k where that is not negative.
struct Hardness {
  double compliance = 0;  ///< alpha [the type's own unit]
  double damping = 0;     ///< beta [N s/m for a distance]
  double pbd = -1;        ///< k in [0, 1]
};

/// What the solver must know of a constraint, whatever its type.
class AnyConstraint {
 public:
  virtual ~AnyConstraint() = default;
  virtual void start_substep() = 0;
  /// One projection. `start` holds the positions before the substep, `projections` how often it is projected in a step.
  virtual void project(std::vector<Particle>& particles, const std::vector<Vec3d>& start, double h, int projections) = 0;
  virtual double value(const std::vector<Particle>& particles) const = 0;
  virtual double multiplier() const = 0;  ///< of the last substep; the force is multiplier / h^2 along the gradient
};

/// A constraint of a type of src/constraints.
template <class Type>
class Constraint final : public AnyConstraint {
 public:
  static constexpr int size = Type::size;
  using Rest = typename Type::template Params<double>;
  using Points = Vec3d[static_cast<std::size_t>(size)];

  Constraint(const std::array<int, static_cast<std::size_t>(size)>& particles, const Rest& rest, const Hardness& hardness)
      : indices_(particles), rest_(rest), hardness_(hardness) {}

  void start_substep() override { multiplier_ = 0; }
  double multiplier() const override { return multiplier_; }

  double value(const std::vector<Particle>& particles) const override {
    Points x, gradient;
    gather(particles, x);
    return Type::template evaluate<double>(x, rest_, gradient);
  }

  void project(std::vector<Particle>& particles, const std::vector<Vec3d>& start, double h, int projections) override {
    Points x, gradient;
    gather(particles, x);
    const double c = Type::template evaluate<double>(x, rest_, gradient);
    double weight = 0, motion = 0;
    for (int i = 0; i < size; ++i) {
      const std::size_t p = at(i);
      weight += particles[p].inverse_mass * length_squared(gradient[i]);
      motion += dot(gradient[i], x[i] - start[p]);
    }
    if (weight == 0) return;
    const double change = hardness_.pbd >= 0 ? pbd_change(c, weight, projections) : xpbd_change(c, weight, motion, h);
    multiplier_ += change;
    for (int i = 0; i < size; ++i) {
      Particle& particle = particles[at(i)];
      particle.position += gradient[i] * (particle.inverse_mass * change);
    }
  }

 private:
  std::size_t at(int i) const { return static_cast<std::size_t>(indices_[static_cast<std::size_t>(i)]); }

  void gather(const std::vector<Particle>& particles, Points& x) const {
    for (int i = 0; i < size; ++i) x[i] = particles[at(i)].position;
  }

  // k' = 1 - (1 - k)^(1/n): after n projections of an isolated linear constraint the share k of its error is gone.
  double pbd_change(double c, double weight, int projections) const {
    const double each = 1 - std::pow(1 - hardness_.pbd, 1.0 / projections);
    return -each * c / weight;
  }

  // Macklin, Mueller and Chentanez 2016, eq. 18 and 26.
  double xpbd_change(double c, double weight, double motion, double h) const {
    const double alpha = hardness_.compliance / (h * h);
    const double gamma = hardness_.compliance * hardness_.damping / h;
    return (-c - alpha * multiplier_ - gamma * motion) / ((1 + gamma) * weight + alpha);
  }

  std::array<int, static_cast<std::size_t>(size)> indices_;
  Rest rest_;
  Hardness hardness_;
  double multiplier_ = 0;
};

/// Particles and constraints, and the loop over them.
class Solver {
 public:
  Vec3d gravity{};     ///< [m/s^2]
  double damping = 0;  ///< share of velocity lost a second is 1 - exp(-damping) [1/s]
  int substeps = 1;
  int iterations = 1;
  std::vector<Particle> particles;

  /// Adds a particle (mass > 0, or infinity for a pin) and returns its index.
  int add(const Vec3d& position, double mass, const Vec3d& velocity = {}) {
    particles.push_back({position, velocity, 1 / mass});
    return static_cast<int>(particles.size()) - 1;
  }

  /// Adds a constraint of a type of src/constraints and returns its index.
  template <class Type>
  int add(const std::array<int, static_cast<std::size_t>(Type::size)>& indices,
          const typename Type::template Params<double>& rest, const Hardness& hardness = {}) {
    constraints_.push_back(std::make_unique<Constraint<Type>>(indices, rest, hardness));
    return static_cast<int>(constraints_.size()) - 1;
  }

  int count() const { return static_cast<int>(constraints_.size()); }
  const AnyConstraint& constraint(int i) const { return *constraints_[static_cast<std::size_t>(i)]; }
  double value(int i) const { return constraint(i).value(particles); }

  /// Advances by dt seconds.
  void step(double dt) {
    for (int i = 0; i < substeps; ++i) substep(dt / substeps);
  }

  double kinetic_energy() const {
    double sum = 0;
    for (const Particle& p : particles)
      if (p.inverse_mass > 0) sum += length_squared(p.velocity) / (2 * p.inverse_mass);
    return sum;
  }

  /// Of the weight, from the origin [J].
  double potential_energy() const {
    double sum = 0;
    for (const Particle& p : particles)
      if (p.inverse_mass > 0) sum -= dot(gravity, p.position) / p.inverse_mass;
    return sum;
  }

 private:
  void substep(double h) {
    std::vector<Vec3d> start(particles.size());
    for (std::size_t i = 0; i < particles.size(); ++i) {
      Particle& p = particles[i];
      start[i] = p.position;
      if (p.inverse_mass == 0) continue;
      p.velocity += gravity * h;
      p.position += p.velocity * h;
    }
    for (auto& constraint : constraints_) constraint->start_substep();
    for (int i = 0; i < iterations; ++i)
      for (auto& constraint : constraints_) constraint->project(particles, start, h, substeps * iterations);
    const double kept = std::exp(-damping * h);
    for (std::size_t i = 0; i < particles.size(); ++i)
      if (particles[i].inverse_mass > 0) particles[i].velocity = (particles[i].position - start[i]) * (kept / h);
  }

  std::vector<std::unique_ptr<AnyConstraint>> constraints_;
};

}  // namespace pliant::reference
