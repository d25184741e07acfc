// Chains: the force at the top, convergence with a heavy end, and the shape between two fixed ends.
#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/validate/rows.h"
#include "pliant/reference.h"

namespace pliant::validate {
namespace {

using reference::Solver;

// ---- twenty particles of 1 kg, the first fixed: the top constraint carries nineteen

constexpr int chain_links = 19;
constexpr float link_length = 0.1f;
constexpr double chain_frame = 1.0 / 60;

Solver hanging_reference(int count, double length, double last_mass, double compliance) {
  Solver solver;
  solver.gravity = {0, -10, 0};
  for (int i = 0; i < count; ++i) solver.add({0, -length * i, 0}, i == 0 ? infinity : i + 1 == count ? last_mass : 1);
  for (int i = 0; i + 1 < count; ++i) solver.add("distance", {i, i + 1}, {length}, {compliance, 0, -1});
  return solver;
}

double reference_force(int iterations) {
  Solver solver = hanging_reference(chain_links + 1, static_cast<double>(link_length), 1, 1e-8);
  solver.iterations = iterations;
  std::vector<double> forces;
  for (int i = 0; i < 900; ++i) {
    solver.step(chain_frame);
    if (i >= 600) forces.push_back(-solver.multiplier(0) / (chain_frame * chain_frame));
  }
  return farthest(10 * chain_links, forces);
}

double engine_force(int iterations) {
  Scene scene =
      scene_with(hanging_line(chain_links + 1, link_length, 1, 1, Stiffness::compliance(1e-8f)), 10, 1, iterations);
  scene.settings.record_multipliers = true;
  World world(scene);
  std::vector<double> forces;
  for (int i = 0; i < 900; ++i) {
    world.step(static_cast<float>(chain_frame));
    if (i < 600) continue;
    const std::vector<float> multipliers = world.object(0).multipliers("distance");
    forces.push_back(multipliers.empty() ? infinity
                                         : -static_cast<double>(multipliers[0]) / (chain_frame * chain_frame));
  }
  return farthest(10 * chain_links, forces);
}

void force_rows(Result& result) {
  const struct {
    int iterations;
    double tolerance;
  } cases[] = {{50, 0.06}, {100, 0.02}, {1000, 0.005}};
  const std::string note =
      "lambda/h^2, the farthest value in 300 frames after 600; alpha 1e-8 m/N, dt 1/60 s, 1 substep";
  for (const auto& [iterations, tolerance] : cases) {
    const std::string name = "force at the top of 20 particles, " + brief(iterations) + " iterations";
    result.rows.push_back(relative("chain: " + name, 190, reference_force(iterations), tolerance, "N", note));
    result.rows.push_back(
        relative("chain: engine, " + name, 190, engine_force(iterations), tolerance, "N", note + ", float"));
  }
}

// ---- the same with 100 t at the end (Macklin et al. 2019): the excess length

constexpr int heavy_count = 20, heavy_frames = 1000;
constexpr double heavy_dt = 0.03, heavy_length = 0.01;

struct Stretching {
  double largest = 0;
  plot::Series curve;
};

void note_length(Stretching& stretching, int i, double length) {
  const double excess = length - heavy_length * (heavy_count - 1);
  stretching.largest = std::isfinite(excess) ? std::max(stretching.largest, excess) : infinity;
  if (i >= 400) return;
  stretching.curve.x.push_back(heavy_dt * (i + 1));
  stretching.curve.y.push_back(excess);
}

Stretching heavy_reference(int substeps, int iterations) {
  Solver solver = hanging_reference(heavy_count, heavy_length, 1e5, 0);
  solver.substeps = substeps;
  solver.iterations = iterations;
  Stretching result;
  for (int i = 0; i < heavy_frames; ++i) {
    solver.step(heavy_dt);
    note_length(result, i, -solver.particles.back().position.y);
  }
  return result;
}

Stretching heavy_engine(int substeps, int iterations) {
  Object line = hanging_line(heavy_count, static_cast<float>(heavy_length), 1, 1e5f, Stiffness::rigid());
  World world(scene_with(line, 10, substeps, iterations));
  Stretching result;
  for (int i = 0; i < heavy_frames; ++i) {
    world.step(static_cast<float>(heavy_dt));
    note_length(result, i, -static_cast<double>(world.object(0).positions().back().y));
  }
  return result;
}

void heavy_rows(Result& result) {
  const std::string note =
      "20 particles, 0.01 m apart, 1 kg, the last 1e5 kg; dt 0.03 s, 1000 frames; largest excess length";
  Stretching iterated = heavy_reference(1, 100), substepped = heavy_reference(100, 1);
  Stretching engine_iterated = heavy_engine(1, 100), engine_substepped = heavy_engine(100, 1);
  const auto add = [&](const std::string& who, const Stretching& a, const Stretching& b) {
    result.rows.push_back(relative("chain: " + who + "heavy end, 100 iterations", 322.1, a.largest, 0.02, "m", note));
    result.rows.push_back(relative("chain: " + who + "heavy end, 100 substeps", 3.24, b.largest, 0.02, "m", note));
    result.rows.push_back(
        relative("chain: " + who + "heavy end, ratio of the two", 99.5, a.largest / b.largest, 0.02, "", note));
  };
  add("", iterated, substepped);
  add("engine, ", engine_iterated, engine_substepped);
  iterated.curve.name = "100 iterations";
  substepped.curve.name = "100 substeps";
  engine_iterated.curve.name = "engine, 100 iterations";
  engine_substepped.curve.name = "engine, 100 substeps";
  engine_iterated.curve.style = engine_substepped.curve.style = plot::Series::Style::dashed;
  result.charts.push_back({"A chain with 100 t at its end: substeps beat iterations",
                           "time [s]",
                           "excess length [m]",
                           false,
                           true,
                           {iterated.curve, substepped.curve, engine_iterated.curve, engine_substepped.curve}});
}

// ---- between two nails: the funicular polygon

constexpr int nail_links = 20;
constexpr double nail_span = 1, nail_length = 1.5, nail_mass = 0.05, nail_g = 10;

// The rise of tan(theta) per link, for which the chain has this span. With equal links and weights, tan(theta)
// increases by m g / H from link to link, symmetrically about the middle.
double span_of(double slope_step, int count, double length) {
  double span = 0;
  for (int i = 0; i < count; ++i) {
    const double slope = slope_step * (i - (count - 1) / 2.0);
    span += length / count / std::sqrt(1 + slope * slope);
  }
  return span;
}

// The rise per link for which the polygon has exactly this span, by bisection: with a larger rise it hangs deeper.
double exact_slope_step(int count, double length, double span) {
  double low = 0, high = 1e6;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (span_of(middle, count, length) > span ? low : high) = middle;
  }
  return (low + high) / 2;
}

double exact_sag(double slope_step, int count, double length) {
  double depth = 0;
  for (int i = 0; 2 * i + 1 < count; ++i) {
    const double slope = slope_step * ((count - 1) / 2.0 - i);
    depth += length / count * slope / std::sqrt(1 + slope * slope);
  }
  return depth;
}

// The sag of a catenary y = a cosh(x / a) with this length and span: 2 a sinh(D / 2a) = L.
double catenary_sag(double length, double span) {
  double low = 1e-3 * span, high = 1e3 * span;
  for (int i = 0; i < 200; ++i) {
    const double a = (low + high) / 2;
    (2 * a * std::sinh(span / (2 * a)) > length ? low : high) = a;
  }
  return low * (std::cosh(span / (2 * low)) - 1);
}

// The initial position of particle i: a V of the right length.
Vec3d nail_start(int i) {
  const double along = nail_length * i / nail_links, half = nail_length / 2, x = nail_span * i / nail_links;
  const double depth = std::sqrt(nail_length * nail_length - nail_span * nail_span) / nail_length;
  return {x, -depth * std::min(along, 2 * half - along), 0};
}

double nail_weight(int i) { return i == 0 || i == nail_links ? infinity : nail_mass; }

Solver nails_reference() {
  Solver solver;
  solver.gravity = {0, -nail_g, 0};
  solver.damping = 20;
  for (int i = 0; i <= nail_links; ++i) solver.add(nail_start(i), nail_weight(i));
  for (int i = 0; i < nail_links; ++i) solver.add("distance", {i, i + 1}, {nail_length / nail_links});
  for (int i = 0; i < 30000; ++i) solver.step(1e-4);
  for (int i = 0; i < 150000; ++i) solver.step(1e-5);  // the links' remaining stretch decreases with h^2
  return solver;
}

std::vector<Vec3f> nails_engine() {
  std::vector<Vec3f> positions;
  std::vector<float> masses;
  std::vector<int> pairs;
  for (int i = 0; i <= nail_links; ++i) {
    const Vec3d x = nail_start(i);
    positions.push_back({static_cast<float>(x.x), static_cast<float>(x.y), 0});
    masses.push_back(static_cast<float>(nail_weight(i)));
    if (i > 0) pairs.insert(pairs.end(), {i - 1, i});
  }
  Object object = particles(positions, masses);
  object.damping = 20;
  connect(object, pairs, std::vector<float>(nail_links, static_cast<float>(nail_length / nail_links)),
          Stiffness::rigid());
  World world(scene_with(object, nail_g, 100, 1));
  for (int i = 0; i < 600; ++i) world.step(1.f / 60);
  return world.object(0).positions();
}

// The difference tan(theta_{i+1}) - tan(theta_i) that is farthest from `expected`, over inner particles.
double farthest_slope_step(const std::vector<Vec3d>& x, double expected) {
  std::vector<double> steps;
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    steps.push_back((x[i + 1].y - x[i].y) / (x[i + 1].x - x[i].x) - (x[i].y - x[i - 1].y) / (x[i].x - x[i - 1].x));
  return farthest(expected, steps);
}

void nail_rows(Result& result) {
  const double step = exact_slope_step(nail_links, nail_length, nail_span),
               sag = exact_sag(step, nail_links, nail_length);
  const Solver solver = nails_reference();
  std::vector<Vec3d> exact, engine;
  for (const auto& p : solver.particles) exact.push_back(p.position);
  for (const Vec3f& p : nails_engine()) engine.push_back({p.x, p.y, p.z});
  const std::string note = "20 links, 1.5 m on a span of 1 m";
  auto& rows = result.rows;
  rows.push_back(relative("chain: funicular polygon, m g / H", step, farthest_slope_step(exact, step), 1e-6, "",
                          "tan(theta) increases by this per link; the farthest value; " + note));
  rows.push_back(relative("chain: funicular polygon, sag", sag, -exact[nail_links / 2].y, 1e-6, "m", note));
  rows.push_back(relative("chain: engine, funicular polygon, m g / H", step, farthest_slope_step(engine, step), 1e-2,
                          "", note + ", 100 substeps, float"));
  rows.push_back(
      relative("chain: engine, funicular polygon, sag", sag, -engine[nail_links / 2].y, 1e-3, "m", note + ", float"));
  rows.push_back(relative("chain: catenary, sag in the limit", catenary_sag(nail_length, nail_span),
                          exact_sag(exact_slope_step(4000, nail_length, nail_span), 4000, nail_length), 1e-6, "m",
                          "the polygon of 4000 links; 2 a sinh(D/2a) = L"));
  plot::Series expected{"funicular polygon", {}, {}, plot::Series::Style::line};
  Vec3d at{};
  for (int i = 0; i <= nail_links; ++i) {
    expected.x.push_back(at.x);
    expected.y.push_back(at.y);
    const double slope = step * (i - (nail_links - 1) / 2.0),
                 along = nail_length / nail_links / std::sqrt(1 + slope * slope);
    at += Vec3d{along, along * slope, 0};
  }
  plot::Series measured{"engine", {}, {}, plot::Series::Style::points};
  for (const Vec3d& p : engine) {
    measured.x.push_back(p.x);
    measured.y.push_back(p.y);
  }
  result.charts.push_back({"A chain between two nails", "x [m]", "y [m]", false, false, {expected, measured}});
}

}  // namespace

void chain_rows(Result& result, bool) {
  force_rows(result);
  heavy_rows(result);
  nail_rows(result);
}

}  // namespace pliant::validate
