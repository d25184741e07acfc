// A mass on a spring. One XPBD iteration on one linear spring equals backward Euler to the last digit. This is the
// sharpest test of compliance, of damping, and of the powers of h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/validate/rows.h"
#include "pliant/reference.h"

namespace pliant::validate {
namespace {

using reference::Hardness;
using reference::Solver;

// A spring along the x-axis from a particle fixed at the origin, without gravity.
struct Spring {
  double mass = 2, stiffness = 300, damping = 0, rest_length = 1, start = 1.25, h = 1.0 / 60;
  int steps = 120;
};

// Backward Euler: x = (m x~ + h^2 k l0 + h b x_n) / (m + h^2 k + h b), x~ = x_n + h v_n; v = (x - x_n) / h. A step damps
// by itself as a damper of k h does, which the solver takes off b (solver/damper.h).
std::vector<double> backward_euler(const Spring& s) {
  std::vector<double> path{s.start};
  double x = s.start, v = 0;
  for (int i = 0; i < s.steps; ++i) {
    const double h = s.h, predicted = x + h * v, damping = std::max(s.damping - s.stiffness * h, 0.);
    const double next = (s.mass * predicted + h * h * s.stiffness * s.rest_length + h * damping * x) /
                        (s.mass + h * h * s.stiffness + h * damping);
    v = (next - x) / h;
    x = next;
    path.push_back(x);
  }
  return path;
}

std::vector<double> by_reference(const Spring& s) {
  Solver solver;
  solver.add({0, 0, 0}, infinity);
  solver.add({s.start, 0, 0}, s.mass);
  solver.add("distance", {0, 1}, {s.rest_length}, {1 / s.stiffness, s.damping, -1});
  std::vector<double> path{s.start};
  for (int i = 0; i < s.steps; ++i) {
    solver.step(s.h);
    path.push_back(solver.particles[1].position.x);
  }
  return path;
}

std::vector<double> by_engine(const Spring& s, int iterations) {
  Object object = particles({{0, 0, 0}, {static_cast<float>(s.start), 0, 0}},
                            {std::numeric_limits<float>::infinity(), static_cast<float>(s.mass)});
  connect(object, {0, 1}, {static_cast<float>(s.rest_length)},
          Stiffness::compliance(static_cast<float>(1 / s.stiffness), static_cast<float>(s.damping)));
  World world(scene_with(object, 0, 1, iterations));
  std::vector<double> path{s.start};
  for (int i = 0; i < s.steps; ++i) {
    world.step(static_cast<float>(s.h));
    path.push_back(static_cast<double>(world.object(0).positions()[1].x));
  }
  return path;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(std::abs(a[i] - b[i]));
  return farthest(0, differences);
}

// A damped oscillation: u(n+1) = 2 r cos(phi) u(n) - r^2 u(n-1). A least-squares fit gives r and phi.
struct Oscillation {
  double amplitude, phase;
};

Oscillation fit(const std::vector<double>& path, double rest) {
  double aa = 0, ab = 0, bb = 0, ac = 0, bc = 0;
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const double a = path[i] - rest, b = path[i - 1] - rest, c = path[i + 1] - rest;
    aa += a * a, ab += a * b, bb += b * b, ac += a * c, bc += b * c;
  }
  const double determinant = aa * bb - ab * ab;
  const double p = (ac * bb - bc * ab) / determinant, q = (bc * aa - ac * ab) / determinant;
  const double r = std::sqrt(-q);
  return {r, std::acos(p / (2 * r))};
}

plot::Series series(const std::string& name, const std::vector<double>& path, double h, plot::Series::Style style,
                    std::size_t stride) {
  plot::Series result{name, {}, {}, style};
  for (std::size_t i = 0; i < path.size() && static_cast<double>(i) * h < 1.5; i += stride) {
    result.x.push_back(static_cast<double>(i) * h);
    result.y.push_back(path[i]);
  }
  return result;
}

void backward_euler_rows(Result& result) {
  const Spring free{}, damped{2, 300, 6, 1, 1.25, 1.0 / 60, 120};
  const double omega = std::sqrt(free.stiffness / free.mass), h = free.h;
  const double r = 1 / std::sqrt(1 + h * h * omega * omega), phi = std::atan(h * omega);
  const auto path = by_reference(free);
  const Oscillation double_fit = fit(path, free.rest_length);
  const auto path_float = by_engine(free, 1), damped_float = by_engine(damped, 1);
  const Oscillation float_fit = fit(path_float, free.rest_length);
  const std::string note = "120 steps of 1/60 s, m = 2 kg, k = 300 N/m";
  auto& rows = result.rows;
  rows.push_back(absolute("spring: XPBD against backward Euler", 0, largest_difference(path, backward_euler(free)),
                          1e-12, "m", note));
  rows.push_back(
      relative("spring: amplitude kept per step", r, double_fit.amplitude, 1e-12, "", "1/sqrt(1 + h^2 w^2)"));
  rows.push_back(relative("spring: phase per step", phi, double_fit.phase, 1e-12, "rad", "atan(h w)"));
  rows.push_back(absolute("spring: damped, against backward Euler", 0,
                          largest_difference(by_reference(damped), backward_euler(damped)), 1e-12, "m",
                          note + ", b = 6 N s/m"));
  rows.push_back(absolute("spring: engine against backward Euler", 0,
                          largest_difference(path_float, backward_euler(free)), 1e-5, "m", note + ", float"));
  rows.push_back(relative("spring: engine, amplitude kept per step", r, float_fit.amplitude, 1e-6, "", "float"));
  rows.push_back(relative("spring: engine, phase per step", phi, float_fit.phase, 1e-5, "rad", "float"));
  rows.push_back(absolute("spring: engine, damped, against backward Euler", 0,
                          largest_difference(damped_float, backward_euler(damped)), 1e-5, "m",
                          note + ", b = 6 N s/m, float"));
  rows.push_back(absolute("spring: engine, damped, 20 iterations", 0,
                          largest_difference(by_engine(damped, 20), backward_euler(damped)), 1e-5, "m",
                          "multipliers persist over iterations"));
  using Style = plot::Series::Style;
  result.charts.push_back({"A mass on a spring is backward Euler",
                           "time [s]",
                           "length [m]",
                           false,
                           false,
                           {series("backward Euler", backward_euler(free), h, Style::line, 1),
                            series("backward Euler, damped", backward_euler(damped), h, Style::line, 1),
                            series("engine", path_float, h, Style::points, 2),
                            series("engine, damped", damped_float, h, Style::points, 2)}});
}

// A mass that hangs on a damped spring until it is at rest. Damping must not change the rest position.
struct Hanging {
  double mass = 1, compliance = 0.01, g = 10, dt = 1.0 / 60;
  int substeps = 1, iterations = 1;
  double critical() const { return 2 * std::sqrt(mass / compliance); }
  int steps() const { return static_cast<int>(std::ceil(6 / dt)); }
};

double reference_stretch(const Hanging& s) {
  Solver solver;
  solver.gravity = {0, -s.g, 0};
  solver.substeps = s.substeps;
  solver.iterations = s.iterations;
  solver.add({0, 0, 0}, infinity);
  solver.add({0, -1, 0}, s.mass);
  solver.add("distance", {0, 1}, {1}, {s.compliance, s.critical(), -1});
  for (int i = 0; i < s.steps(); ++i) solver.step(s.dt);
  return solver.value(0);
}

double engine_stretch(const Hanging& s) {
  const Stiffness spring = Stiffness::compliance(static_cast<float>(s.compliance), static_cast<float>(s.critical()));
  const float mass = static_cast<float>(s.mass);
  World world(scene_with(hanging_line(2, 1, mass, mass, spring), s.g, s.substeps, s.iterations));
  for (int i = 0; i < s.steps(); ++i) world.step(static_cast<float>(s.dt));
  return -1 - static_cast<double>(world.object(0).positions()[1].y);
}

void static_rows(Result& result) {
  for (double mass : {1.0, 2.0, 5.0}) {
    std::vector<double> exact, engine;
    for (int iterations : {1, 5, 20})
      for (int substeps : {1, 10, 50})
        for (double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
          const Hanging s{mass, 0.01, 10, dt, substeps, iterations};
          exact.push_back(reference_stretch(s));
          engine.push_back(engine_stretch(s));
        }
    const double expected = mass * 10 * 0.01;
    const std::string note = "farthest of 27: iterations 1, 5, 20; substeps 1, 10, 50; dt 1/30, 1/60, 1/240 s";
    const std::string name = brief(mass) + " kg on 100 N/m";
    result.rows.push_back(
        relative("spring: static stretch, " + name, expected, farthest(expected, exact), 1e-6, "m", note));
    result.rows.push_back(
        relative("spring: engine, static stretch, " + name, expected, farthest(expected, engine), 1e-4, "m", note));
  }
}

// The height of a falling particle after n substeps is x0 - g h^2 n (n + 1) / 2, in any precision.
double engine_fall(int substeps, double dt, int frames) {
  Scene scene = scene_with(particles({{0.5f, 2, -0.25f}}, {0.3f}), 9.81, substeps, 1);
  World world(scene);
  for (int i = 0; i < frames; ++i) world.step(static_cast<float>(dt));
  return 2 - static_cast<double>(world.object(0).positions()[0].y);
}

void float_rows(Result& result) {
  for (int substeps : {1, 10, 100, 1000}) {
    const double dt = 1.0 / 60, h = dt / substeps, n = 60.0 * substeps;
    const std::string name = brief(substeps) + (substeps == 1 ? " substep" : " substeps");
    result.rows.push_back(relative("spring: engine, free fall for 1 s, " + name, 9.81 * h * h * n * (n + 1) / 2,
                                   engine_fall(substeps, dt, 60), 1e-4, "m", "g h^2 n(n+1)/2, float"));
    const Hanging s{1, 0.01, 10, dt, substeps, 1};
    result.rows.push_back(
        relative("spring: engine, hanging at rest, " + name, 0.1, engine_stretch(s), 1e-4, "m", "float"));
  }
}

}  // namespace

void spring_rows(Result& result, bool) {
  backward_euler_rows(result);
  static_rows(result);
  float_rows(result);
}

}  // namespace pliant::validate
