#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "constraints/all.h"
#include "pliant/constraint.h"
#include "pliant/error.h"
#include "pliant/reference.h"

namespace pliant::reference {

/// One pass over the constraints.
struct Pass {
  double h = 0;                          ///< length of the substep [s]
  int projections = 1;                   ///< of each constraint in a frame
  bool is_first = true, is_only = true;  ///< of the substep
};

/// A constraint as the reference solver sees it, whatever its type.
class AnyConstraint {
 public:
  virtual ~AnyConstraint() = default;
  virtual void start_substep() = 0;
  /// Projects the constraint once. `start` has the positions before the substep.
  virtual void project(std::vector<Particle>& particles, const std::vector<Vec3d>& start, const Pass& pass) = 0;
  virtual double value(const std::vector<Particle>& particles) const = 0;
  virtual double multiplier() const = 0;
};

namespace {

template <class T>
inline constexpr std::size_t size_of = static_cast<std::size_t>(slot_count<T>);

template <class T>
using Rest = typename T::template Params<double>;

template <class T>
inline constexpr std::size_t rest_size = T::fields.size();

template <class T>
using Places = Vec3d[size_of<T>];

void require(bool holds, const std::string& type, const std::string& problem) {
  if (!holds) throw Error({.element = type + " constraint"}, problem, "see docs/reference/constraints.md");
}

template <class T>
Rest<T> rest_of(const std::vector<double>& numbers) {
  require(numbers.size() == rest_size<T>, T::name,
          "has " + std::to_string(numbers.size()) + " numbers of rest data, not " + std::to_string(rest_size<T>));
  Rest<T> rest;
  std::memcpy(&rest, numbers.data(), sizeof rest);
  return rest;
}

template <class T>
void copy_stencil(const std::vector<Vec3d>& from, Places<T>& to) {
  require(from.size() == size_of<T>, T::name,
          "has " + std::to_string(from.size()) + " particles, not " + std::to_string(size_of<T>));
  for (std::size_t i = 0; i < size_of<T>; ++i) to[i] = from[i];
}

/// Calls visit(TypeTag<T>{}) for the constraint type T with this name.
template <class Visit>
void with_name(const std::string& type, const Visit& visit) {
  bool found = false;
  for_each_type(AllConstraints{}, [&](auto tag, int) {
    using T = typename decltype(tag)::type;
    if constexpr (in_lanes<T>) {  // this solver supports only types of one row over points
      if (type != T::name) return;
      found = true;
      visit(tag);
    }
  });
  require(found, "'" + type + "'", "is not a type with one row over particles");
}

template <class T>
class Constraint final : public AnyConstraint {
 public:
  Constraint(const std::vector<int>& particles, const Rest<T>& rest, const Hardness& hardness)
      : rest_(rest), hardness_(hardness) {
    for (std::size_t i = 0; i < size_of<T>; ++i) indices_[i] = static_cast<std::size_t>(particles[i]);
  }

  void start_substep() override { multiplier_ = 0; }
  double multiplier() const override { return multiplier_; }

  double value(const std::vector<Particle>& particles) const override {
    Places<T> x, gradient;
    gather(particles, x);
    return T::template evaluate<double>(x, rest_, gradient);
  }

  void project(std::vector<Particle>& particles, const std::vector<Vec3d>& start, const Pass& pass) override {
    Places<T> x, gradient;
    gather(particles, x);
    const double c = T::template evaluate<double>(x, rest_, gradient);
    double weight = 0, along = 0;
    Places<T> motion;
    for (std::size_t i = 0; i < size_of<T>; ++i) {
      motion[i] = x[i] - start[indices_[i]];
      weight += particles[indices_[i]].inverse_mass * length_squared(gradient[i]);
      along += dot(gradient[i], motion[i]);
    }
    if (weight == 0) return;
    if constexpr (measures_strain<T>)
      if (pass.is_first && hardness_.pbd < 0 && hardness_.damping > 0)
        return project_strain(particles, x, motion, pass);
    const double change =
        hardness_.pbd >= 0 ? pbd_change(c, weight, pass.projections) : xpbd_change(c, weight, along, pass);
    multiplier_ += change;
    move(particles, gradient, change);
  }

 private:
  void gather(const std::vector<Particle>& particles, Places<T>& x) const {
    for (std::size_t i = 0; i < size_of<T>; ++i) x[i] = particles[indices_[i]].position;
  }

  void move(std::vector<Particle>& particles, const Places<T>& gradient, double change) const {
    for (std::size_t i = 0; i < size_of<T>; ++i) {
      Particle& particle = particles[indices_[i]];
      particle.position += gradient[i] * (particle.inverse_mass * change);
    }
  }

  // A damped type that measures a strain, in the first pass: the elastic and the viscous stress act as one constraint
  // along their sum (docs/internals/integrator.md).
  void project_strain(std::vector<Particle>& particles, const Places<T>& x, const Places<T>& motion, const Pass& pass) {
    const auto f = T::deformation(x, rest_), by = T::deformation(motion, rest_);
    auto g = f;
    const double c = T::evaluate_at(f, rest_, g), h = pass.h;
    const auto across = T::change_across(f, by);
    const double along = dot(g.x, by.x) + dot(g.y, by.y) + dot(g.z, by.z);
    const double alpha = hardness_.compliance / (h * h), gamma = viscous_share(h);
    const double stress = c + gamma * along;
    const double size = std::sqrt(stress * stress + 2 * gamma * gamma * across.squares());
    if (!(size > 0)) return;
    Places<T> gradient;
    T::to_corners(g * (stress / size) + f.times(across) * (2 * gamma / size), rest_, gradient);
    double weight = 0;
    for (std::size_t i = 0; i < size_of<T>; ++i)
      weight += particles[indices_[i]].inverse_mass * length_squared(gradient[i]);
    const double share = stress * stress / (size * size), rigid = (gamma + share) * weight;
    const double led_part = pass.is_only ? lead * (1 + gamma) * share * weight : 0;
    const double denominator = std::max(rigid + alpha - led_part, rigid);
    if (!(denominator > 0)) return;
    multiplier_ -= stress / denominator;
    move(particles, gradient, -size / denominator);
  }

  // gamma of eq. 26, less the one substep that implicit Euler damps as by itself (docs/internals/integrator.md).
  double viscous_share(double h) const { return std::max(hardness_.compliance * hardness_.damping / h - 1, 0.); }

  // PBD: k' = 1 - (1 - k)^(1/n). n projections of an isolated linear constraint remove the share k of its error.
  double pbd_change(double c, double weight, int projections) const {
    // libm is allowed in this oracle: results are compared within a tolerance, never by their bits.
    const double each = 1 - std::pow(1 - hardness_.pbd, 1.0 / projections);
    return -each * c / weight;
  }

  // XPBD: Macklin, Mueller and Chentanez 2016, eq. 18 and 26. One pass over a solid or woven cloth leaves it too soft
  // by half of its own denominator, so its compliance is lowered (docs/internals/solids.md, woven.md).
  double xpbd_change(double c, double weight, double motion, const Pass& pass) const {
    const double alpha = hardness_.compliance / (pass.h * pass.h);
    const double gamma = viscous_share(pass.h);
    const double rigid = (1 + gamma) * weight;
    const double denominator =
        is_led<T> && pass.is_only ? std::max(rigid + alpha - lead * rigid, rigid) : rigid + alpha;
    return (-c - alpha * multiplier_ - gamma * motion) / denominator;
  }

  static constexpr double lead = 0.62;  // solid and woven cloth: see xpbd_change
  std::array<std::size_t, size_of<T>> indices_{};
  Rest<T> rest_;
  Hardness hardness_;
  double multiplier_ = 0;
};

}  // namespace

Evaluation evaluate(const std::string& type, const std::vector<Vec3d>& x, const std::vector<double>& rest) {
  Evaluation out;
  with_name(type, [&](auto tag) {
    using T = typename decltype(tag)::type;
    Places<T> places, gradients;
    copy_stencil<T>(x, places);
    out.value = T::template evaluate<double>(places, rest_of<T>(rest), gradients);
    out.gradients.assign(gradients, gradients + size_of<T>);
  });
  return out;
}

std::vector<double> measure(const std::string& type, const std::vector<Vec3d>& x) {
  std::vector<double> out;
  with_name(type, [&](auto tag) {
    using T = typename decltype(tag)::type;
    Places<T> places;
    copy_stencil<T>(x, places);
    if constexpr (detail::measures_points<T>) {
      const Rest<T> rest = T::template measure<double>(places);
      out.resize(rest_size<T>);
      std::memcpy(out.data(), &rest, sizeof rest);
    }
  });
  return out;
}

Solver::Solver() = default;
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

int Solver::add(const Vec3d& position, double mass, const Vec3d& velocity) {
  particles.push_back({position, velocity, 1 / mass});
  return static_cast<int>(particles.size()) - 1;
}

int Solver::add(const std::string& type, const std::vector<int>& stencil, const std::vector<double>& rest,
                const Hardness& hardness) {
  std::vector<Vec3d> x;
  for (const int p : stencil) {
    require(p >= 0 && p < static_cast<int>(particles.size()), type, "names particle " + std::to_string(p));
    x.push_back(particles[static_cast<std::size_t>(p)].position);
  }
  const std::vector<double> used = rest.empty() ? measure(type, x) : rest;
  with_name(type, [&](auto tag) {
    using T = typename decltype(tag)::type;
    require(x.size() == size_of<T>, T::name, "has " + std::to_string(x.size()) + " particles");
    constraints_.push_back(std::make_unique<Constraint<T>>(stencil, rest_of<T>(used), hardness));
  });
  return constraint_count() - 1;
}

double Solver::value(int constraint) const {
  return constraints_[static_cast<std::size_t>(constraint)]->value(particles);
}

double Solver::multiplier(int constraint) const {
  return constraints_[static_cast<std::size_t>(constraint)]->multiplier();
}

void Solver::step(double dt) {
  for (int i = 0; i < substeps; ++i) substep(dt / substeps);
}

double Solver::kinetic_energy() const {
  double sum = 0;
  for (const Particle& p : particles)
    if (p.inverse_mass > 0) sum += length_squared(p.velocity) / (2 * p.inverse_mass);
  return sum;
}

double Solver::potential_energy() const {
  double sum = 0;
  for (const Particle& p : particles)
    if (p.inverse_mass > 0) sum -= dot(gravity, p.position) / p.inverse_mass;
  return sum;
}

void Solver::substep(double h) {
  std::vector<Vec3d> start;
  for (Particle& p : particles) {
    start.push_back(p.position);
    if (p.inverse_mass == 0) continue;
    p.velocity += gravity * h;
    p.position += p.velocity * h;
  }
  for (auto& constraint : constraints_) constraint->start_substep();
  for (int i = 0; i < iterations; ++i)
    for (auto& constraint : constraints_)
      constraint->project(particles, start, {h, substeps * iterations, i == 0, iterations == 1});
  const double kept = std::exp(-damping * h);  // libm, as in pbd_change
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (particles[i].inverse_mass > 0) particles[i].velocity = (particles[i].position - start[i]) * (kept / h);
}

}  // namespace pliant::reference
