// A mass on a rigid link: its period grows with the amplitude by the complete elliptic integral, and its energy only
// decreases, slowly.
#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/validate/rows.h"
#include "pliant/reference.h"

namespace pliant::validate {
namespace {

// The arithmetic-geometric mean gives the complete elliptic integral: T / T0 = 1 / agm(1, cos(amplitude / 2)).
double exact_period_ratio(double amplitude) {
  double a = 1, b = std::cos(amplitude / 2);
  for (int i = 0; i < 40; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 1 / a;
}

// A pendulum of 1 m and 1 kg, whichever solver moves it.
struct Bob {
  Vec3d position, velocity;
};

Vec3d bob_at(double angle) { return {std::sin(angle), -std::cos(angle), 0}; }

class ReferencePendulum {
 public:
  ReferencePendulum(double angle, int substeps) {
    solver_.gravity = {0, -standard_gravity, 0};
    solver_.substeps = substeps;
    solver_.add({0, 0, 0}, std::numeric_limits<double>::infinity());
    solver_.add(bob_at(angle), 1);
    solver_.add("distance", {0, 1}, {1});
  }
  void step(double dt) { solver_.step(dt); }
  Bob bob() const { return {solver_.particles[1].position, solver_.particles[1].velocity}; }

 private:
  reference::Solver solver_;
};

Scene pendulum_scene(double angle, int substeps) {
  const Vec3d x = bob_at(angle);
  Object object = particles({{0, 0, 0}, {static_cast<float>(x.x), static_cast<float>(x.y), 0}},
                            {std::numeric_limits<float>::infinity(), 1});
  connect(object, {0, 1}, {1}, Stiffness::rigid());
  return scene_with(object, standard_gravity, substeps, 1);
}

class EnginePendulum {
 public:
  EnginePendulum(double angle, int substeps) : world_(pendulum_scene(angle, substeps)) {}
  void step(double dt) { world_.step(static_cast<float>(dt)); }
  Bob bob() const {
    const Vec3f x = world_.object(0).positions()[1], v = world_.object(0).velocities()[1];
    return {{x.x, x.y, x.z}, {v.x, v.y, v.z}};
  }

 private:
  World world_;
};

// The time between the first and the third passage through the lowest point, interpolated between frames.
template <class Pendulum>
double period(double amplitude, int substeps, double dt) {
  Pendulum pendulum(amplitude, substeps);
  double before = std::sin(amplitude), first = -1;
  for (int i = 1, passages = 0; i * dt < 20; ++i) {
    pendulum.step(dt);
    const double x = pendulum.bob().position.x;
    if ((x < 0) != (before < 0)) {
      const double time = (i - x / (x - before)) * dt;
      if (++passages == 3) return time - first;
      if (passages == 1) first = time;
    }
    before = x;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void period_rows(Result& result) {
  constexpr int substeps = 50;
  constexpr double dt = 1.0 / 600;
  const double t0 = 2 * pi * std::sqrt(1 / standard_gravity);
  plot::Series exact{"elliptic integral", {}, {}, plot::Series::Style::line},
      engine{"engine", {}, {}, plot::Series::Style::points};
  for (int degrees = 0; degrees <= 160; degrees += 2) {
    exact.x.push_back(degrees);
    exact.y.push_back(exact_period_ratio(degrees * pi / 180));
  }
  for (int degrees : {10, 30, 60, 90, 120, 150}) {
    const double amplitude = degrees * pi / 180, expected = exact_period_ratio(amplitude);
    const double by_reference = period<ReferencePendulum>(amplitude, substeps, dt) / t0;
    const double by_engine = period<EnginePendulum>(amplitude, substeps, dt) / t0;
    const std::string name = "period over T0 at " + brief(degrees) + " degrees", note = "1 m, h = 1/30000 s, one swing";
    result.rows.push_back(relative("pendulum: " + name, expected, by_reference, 5e-3, "", note));
    result.rows.push_back(relative("pendulum: engine, " + name, expected, by_engine, 5e-3, "", note + ", float"));
    engine.x.push_back(degrees);
    engine.y.push_back(by_engine);
  }
  result.charts.push_back({"The period of a pendulum", "amplitude [degrees]", "T / T0", false, false, {exact, engine}});
}

struct Energy {
  double highest = 0, last = 0;  // energies above the lowest point, as shares of the initial one
  plot::Series curve;
};

template <class Pendulum>
Energy follow(double amplitude, int substeps, double dt, int frames) {
  Pendulum pendulum(amplitude, substeps);
  const double start = standard_gravity * (1 - std::cos(amplitude));
  Energy energy;
  for (int i = 0; i < frames; ++i) {
    pendulum.step(dt);
    const Bob bob = pendulum.bob();
    energy.last = (standard_gravity * (1 + bob.position.y) + length_squared(bob.velocity) / 2) / start;
    energy.highest = std::isfinite(energy.last) ? std::max(energy.highest, energy.last) : energy.last;
    energy.curve.x.push_back((i + 1) * dt);
    energy.curve.y.push_back(energy.last);
  }
  return energy;
}

void energy_rows(Result& result) {
  const std::string note = "90 degrees, 1 m, 10 s, 1000 substeps of 1/60000 s";
  Energy exact = follow<ReferencePendulum>(pi / 2, 1000, 1.0 / 60, 600);
  Energy engine = follow<EnginePendulum>(pi / 2, 1000, 1.0 / 60, 600);
  const Energy coarse = follow<EnginePendulum>(pi / 2, 20, 1.0 / 60, 600);
  auto& rows = result.rows;
  rows.push_back(at_most("pendulum: highest energy over the start's", 1 + 1e-4, exact.highest, "", note));
  rows.push_back(relative("pendulum: energy left after 10 s", 1, exact.last, 5e-3, "", note));
  rows.push_back(
      at_most("pendulum: engine, highest energy over the start's", 1 + 1e-4, engine.highest, "", note + ", float"));
  rows.push_back(relative("pendulum: engine, energy left after 10 s", 1, engine.last, 5e-3, "", note + ", float"));
  rows.push_back(at_most("pendulum: engine, highest energy, 20 substeps", 1 + 5e-3, coarse.highest, "",
                         "of 1/1200 s; left after 10 s: " + brief(coarse.last)));
  exact.curve.name = "reference, 1000 substeps";
  engine.curve.name = "engine, 1000 substeps";
  plot::Series twenty = coarse.curve;
  twenty.name = "engine, 20 substeps";
  exact.curve.style = plot::Series::Style::dashed;
  result.charts.push_back({"Energy of a pendulum from 90 degrees",
                           "time [s]",
                           "energy / at the start",
                           false,
                           false,
                           {exact.curve, engine.curve, twenty}});
}

}  // namespace

void pendulum_rows(Result& result, bool) {
  period_rows(result);
  energy_rows(result);
}

}  // namespace pliant::validate
