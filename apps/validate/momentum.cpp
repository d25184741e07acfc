// Invariants of a constraint: it conserves linear and angular momentum, and its gradient is correct.
//
// A projection conserves sum m x' x dx, x' the positions at which its gradient is taken. The velocity update conserves
// linear momentum exactly. Angular momentum decays slightly, as in backward Euler, because the impulse acts along the
// direction at the substep's end. For a spinning dumbbell this decay is known in closed form.
#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/validate/rows.h"
#include "pliant/reference.h"

namespace pliant::validate {
namespace {

using reference::Solver;

// ---- one constraint at a time

struct Worst {
  double gradient = 0, force = 0, torque = 0, linear = 0, angular = 0;
};

struct Sample {
  std::string type;
  std::vector<Vec3d> x;
  std::vector<double> rest;

  double value() const { return reference::evaluate(type, x, rest).value; }
};

// A random stencil with rest data measured at another one, so that C is not zero.
Sample make_sample(const ConstraintType& type, Random& random) {
  Sample sample{type.name, std::vector<Vec3d>(static_cast<std::size_t>(type.stencil_size)), {}};
  for (Vec3d& x : sample.x) x = random.vector(1);
  sample.rest = reference::measure(type.name, sample.x);
  for (Vec3d& x : sample.x) x += random.vector(0.2);
  return sample;
}

// The five-point central difference of C with respect to one coordinate of one particle.
double difference(Sample sample, double Vec3d::*coordinate, std::size_t particle) {
  constexpr double step = 2e-4;
  const double at = sample.x[particle].*coordinate;
  const auto value = [&](double offset) {
    sample.x[particle].*coordinate = at + offset;
    return sample.value();
  };
  const double near = value(step) - value(-step), far = value(2 * step) - value(-2 * step);
  return (8 * near - far) / (12 * step);
}

// Compares gradients with differences; errors are relative to the largest gradient of the stencil.
void compare_gradients(const Sample& sample, const std::vector<Vec3d>& gradient, Worst& worst) {
  Vec3d force{}, torque{};
  double scale = 0;
  for (const Vec3d& g : gradient) scale = std::max(scale, length(g));
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    const Vec3d numeric{difference(sample, &Vec3d::x, i), difference(sample, &Vec3d::y, i),
                        difference(sample, &Vec3d::z, i)};
    worst.gradient = std::max(worst.gradient, length(numeric - gradient[i]) / scale);
    force += gradient[i];
    torque += cross(sample.x[i], gradient[i]);
  }
  worst.force = std::max(worst.force, length(force) / scale);
  worst.torque = std::max(worst.torque, length(torque) / scale);
}

// Projects once with random masses. Errors are relative to the sum of |m dx| and of |x| |m dx|.
void compare_momenta(const Sample& sample, Random& random, Worst& worst) {
  Solver solver;
  std::vector<int> indices;
  for (const Vec3d& x : sample.x) indices.push_back(solver.add(x, random.uniform(0.5, 2)));
  solver.add(sample.type, indices, sample.rest);
  solver.step(1);
  Vec3d linear{}, angular{};
  double scale = 1e-300;
  for (std::size_t i = 0; i < sample.x.size(); ++i) {
    const Vec3d push = (solver.particles[i].position - sample.x[i]) * (1 / solver.particles[i].inverse_mass);
    linear += push;
    angular += cross(sample.x[i], push);
    scale += length(push);
  }
  worst.linear = std::max(worst.linear, length(linear) / scale);
  worst.angular = std::max(worst.angular, length(angular) / scale);
}

void type_rows(Result& result, const ConstraintType& type) {
  Random random(2017);
  Worst worst;
  const double cut = type.name == "triangle_shear" ? 1.4 : 2.5;  // where angles turn back: at pi / 2, and at pi
  int samples = 0;
  while (samples < 1000) {
    const Sample sample = make_sample(type, random);
    const reference::Evaluation at = reference::evaluate(type.name, sample.x, sample.rest);
    double largest = 0;
    for (const Vec3d& g : at.gradients) largest = std::max(largest, length(g));
    // Skips samples that are too steep for differences, near the branch cut of an angle, or whose value is too small.
    if (largest > 30 || std::abs(at.value) > cut || std::abs(at.value) < 0.05 * largest) continue;
    ++samples;
    compare_gradients(sample, at.gradients, worst);
    compare_momenta(sample, random, worst);
  }
  const std::string name = type.name + ", ", note = "largest of 1000 random positions";
  auto& rows = result.rows;
  rows.push_back(absolute("momentum: " + name + "gradient against differences", 0, worst.gradient, 1e-9, "", note));
  rows.push_back(absolute("momentum: " + name + "net force", 0, worst.force, 1e-9, "", note));
  rows.push_back(absolute("momentum: " + name + "net torque", 0, worst.torque, 1e-9, "", note));
  rows.push_back(absolute("momentum: " + name + "linear, changed by a projection", 0, worst.linear, 1e-13, "", note));
  rows.push_back(absolute("momentum: " + name + "angular, changed by a projection", 0, worst.angular, 1e-13, "", note));
}

// ---- a crumpled sheet in free flight

constexpr int sheet_side = 6;

TriangleMesh crumpled_sheet(Random& random) {
  TriangleMesh mesh = grid_mesh(sheet_side, sheet_side, 1, 1);
  for (Vec3f& x : mesh.positions) x.y += static_cast<float>(random.uniform(-0.1, 0.1));
  return mesh;
}

Object flying_sheet() {
  Random random(7);
  ClothOptions options;
  options.stretch = Stiffness::compliance(1e-4f);
  options.bending = Stiffness::compliance(1e-2f);
  Object object = make_cloth(crumpled_sheet(random), options);
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    const Vec3d v = random.vector(2);
    object.velocities.push_back(
        {static_cast<float>(v.x + 1), static_cast<float>(v.y - 0.5), static_cast<float>(v.z + 2)});
  }
  return object;
}

Solver reference_of(const Object& object) {
  Solver solver;
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    const Vec3f &x = object.positions[i], &v = object.velocities[i];
    solver.add({x.x, x.y, x.z}, object.masses[i], {v.x, v.y, v.z});
  }
  for (const ConstraintGroup& group : object.constraints) {
    const auto type = std::find_if(constraint_types().begin(), constraint_types().end(),
                                   [&](const ConstraintType& t) { return t.name == group.type; });
    const auto size = static_cast<std::size_t>(type->stencil_size);
    for (std::size_t first = 0; first < group.particles.size(); first += size) {
      const float own = group.compliances.empty() ? group.stiffness.value : group.compliances[first / size];
      const auto begin = group.particles.begin() + static_cast<std::ptrdiff_t>(first);
      solver.add(group.type, {begin, begin + type->stencil_size}, {}, {own, 0, -1});
    }
  }
  return solver;
}

struct Momentum {
  Vec3d linear{};
  double scale = 0;  // sum of m |v| over all particles
};

Momentum momentum_of(const Solver& solver) {
  Momentum sum;
  for (const auto& p : solver.particles) {
    sum.linear += p.velocity * (1 / p.inverse_mass);
    sum.scale += length(p.velocity) / p.inverse_mass;
  }
  return sum;
}

Momentum momentum_of(const World& world, const Object& object) {
  Momentum sum;
  const std::vector<Vec3f> v = world.object(0).velocities();
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double m = static_cast<double>(object.masses[i]);
    const Vec3d velocity{v[i].x, v[i].y, v[i].z};
    sum.linear += velocity * m;
    sum.scale += length(velocity) * m;
  }
  return sum;
}

double change(const Momentum& before, const Momentum& after) {
  return length(after.linear - before.linear) / before.scale;
}

void sheet_rows(Result& result) {
  const Object object = flying_sheet();
  Solver solver = reference_of(object);
  solver.iterations = 10;
  World world(scene_with(object, 0, 1, 10));
  const Momentum exact = momentum_of(solver), before = momentum_of(world, object);
  for (int i = 0; i < 60; ++i) {
    solver.step(1.0 / 60);
    world.step(1.f / 60);
  }
  const std::string note =
      "a crumpled sheet with bending flies for 1 s, 1 step of 10 iterations a frame; relative to sum m |v|";
  result.rows.push_back(
      absolute("momentum: flying sheet, linear", 0, change(exact, momentum_of(solver)), 1e-13, "", note));
  result.rows.push_back(absolute("momentum: engine, flying sheet, linear", 0,
                                 change(before, momentum_of(world, object)), 1e-4, "", note + ", float"));
}

// ---- a spinning dumbbell

constexpr double dumbbell_spin = 6, dumbbell_h = 1.0 / 200;
constexpr int dumbbell_steps = 200;

// The velocity is that of the last chord, which is rotated by half of its angle D against the circle: h v has the
// components r sin D along it and r (1 - cos D) outward. So tan D' = sin D / (2 - cos D), with tan D = h omega at the
// start.
double discrete_spin() {
  double angle = std::atan(dumbbell_h * dumbbell_spin);
  for (int i = 1; i < dumbbell_steps; ++i) angle = std::atan(std::sin(angle) / (2 - std::cos(angle)));
  return std::sin(angle) / dumbbell_h;
}

double spin_of(const Vec3d& x, const Vec3d& v) { return cross(x, v).z / length_squared(x); }

double reference_spin() {
  Solver solver;
  solver.add({0.5, 0, 0}, 1, {0, 0.5 * dumbbell_spin, 0});
  solver.add({-0.5, 0, 0}, 1, {0, -0.5 * dumbbell_spin, 0});
  solver.add("distance", {0, 1}, {1});
  for (int i = 0; i < dumbbell_steps; ++i) solver.step(dumbbell_h);
  return spin_of(solver.particles[0].position, solver.particles[0].velocity);
}

double engine_spin(int frames, int substeps) {
  Object object = particles({{0.5f, 0, 0}, {-0.5f, 0, 0}}, {1, 1});
  const float speed = static_cast<float>(0.5 * dumbbell_spin);
  object.velocities = {{0, speed, 0}, {0, -speed, 0}};
  connect(object, {0, 1}, {1}, Stiffness::rigid());
  World world(scene_with(object, 0, substeps, 1));
  for (int i = 0; i < frames; ++i) world.step(1.f / static_cast<float>(frames));
  const Vec3f x = world.object(0).positions()[0], v = world.object(0).velocities()[0];
  return spin_of({x.x, x.y, x.z}, {v.x, v.y, v.z});
}

void dumbbell_rows(Result& result) {
  const double expected = discrete_spin();
  const std::string note = "1 s at 6 rad/s, h = 1/200 s; tan D' = sin D / (2 - cos D)";
  result.rows.push_back(
      relative("momentum: spinning dumbbell, angular", expected, reference_spin(), 1e-12, "rad/s", note));
  result.rows.push_back(relative("momentum: engine, spinning dumbbell, angular", expected, engine_spin(20, 10), 1e-4,
                                 "rad/s", note + ", float"));
  result.rows.push_back(relative("momentum: engine, spin kept", dumbbell_spin, engine_spin(60, 100), 1e-2, "rad/s",
                                 "h = 1/6000 s: the decay is h omega^2 a second"));
}

}  // namespace

void momentum_rows(Result& result, bool) {
  for (const ConstraintType& type : constraint_types())
    if (type.rows == 1 && std::find(type.slots.begin(), type.slots.end(), SlotKind::frame) == type.slots.end())
      type_rows(result, type);  // the reference solver has no frames
  sheet_rows(result);
  dumbbell_rows(result);
}

}  // namespace pliant::validate
