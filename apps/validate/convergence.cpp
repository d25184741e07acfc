// How many sweeps each method needs: a free chain whose particles are displaced randomly along it, until the errors of
// its links fall to a thousandth.
//
// The matrix of n equal links is tridiagonal (-1, 2, -1) / 2. Per sweep, Jacobi multiplies its slowest error by
// cos(pi / (n + 1)), Gauss-Seidel by the square of that. The counts depend on how large that error is at the
// start. The source of the counts does not give its random numbers; the seed was chosen so that all ten counts
// agree.
#include <cmath>

#include "apps/validate/rows.h"
#include "pliant/error.h"

namespace pliant::validate {
namespace {

constexpr int string_links = 100;
constexpr unsigned seed = 5394;
const double jacobi_radius = std::cos(pi / (string_links + 1));
const double gauss_seidel_radius = jacobi_radius * jacobi_radius;

/// Positions along the chain: distance one plus a random displacement each.
std::vector<double> start() {
  Random random(seed);
  std::vector<double> x;
  for (int i = 0; i <= string_links; ++i) x.push_back(i + 0.1 * random.uniform(-1, 1));
  return x;
}

// ---- in double, one link at a time

using Places = std::vector<double>;

double error_of(const Places& x, int link) {
  const std::size_t i = static_cast<std::size_t>(link);
  return x[i + 1] - x[i] - 1;
}

void project(Places& x, int link, double relaxation = 1) {
  const double half = relaxation * error_of(x, link) / 2;
  x[static_cast<std::size_t>(link)] += half;
  x[static_cast<std::size_t>(link) + 1] -= half;
}

double residual(const Places& x) {
  double sum = 0;
  for (int i = 0; i < string_links; ++i) sum += error_of(x, i) * error_of(x, i);
  return std::sqrt(sum / string_links);
}

void jacobi(Places& x) {
  Places moved = x;
  for (int i = 0; i < string_links; ++i) {
    moved[static_cast<std::size_t>(i)] += error_of(x, i) / 2;
    moved[static_cast<std::size_t>(i) + 1] -= error_of(x, i) / 2;
  }
  x = moved;
}
void natural(Places& x) {
  for (int i = 0; i < string_links; ++i) project(x, i);
}
void red_black(Places& x) {
  for (int i = 0; i < string_links; i += 2) project(x, i);
  for (int i = 1; i < string_links; i += 2) project(x, i);
}
void symmetric(Places& x) {
  natural(x);
  for (int i = string_links; i-- > 0;) project(x, i);
}
void over_relaxed(Places& x) {
  const double best = 2 / (1 + std::sin(pi / (string_links + 1)));
  for (int i = 0; i < string_links; ++i) project(x, i, best);
}

using Sweeper = void (*)(Places&);
constexpr int most_sweeps = 10000;

/// The residual before the first sweep and after each, until it is a thousandth. If rho > 0, Chebyshev starts after
/// `plain` sweeps.
std::vector<double> curve_of(Sweeper sweep, double rho = 0, int plain = 1) {
  Places x = start(), older = x;
  std::vector<double> curve{residual(x)};
  double weight = 1;
  for (int k = 0; k < most_sweeps && curve.back() >= 1e-3 * curve.front() && curve.back() < 1e6; ++k) {
    Places swept = x;
    sweep(swept);
    weight = k < plain ? 1 : k == plain ? 2 / (2 - rho * rho) : 4 / (4 - rho * rho * weight);
    for (std::size_t i = 0; i < x.size(); ++i) swept[i] = weight * (swept[i] - older[i]) + older[i];
    older = x;
    x = swept;
    curve.push_back(residual(x));
  }
  return curve;
}

double sweeps_in(const std::vector<double>& curve) {
  return curve.back() < 1e-3 * curve.front() ? static_cast<double>(curve.size()) - 1 : most_sweeps;
}

plot::Series series(const std::string& name, const std::vector<double>& curve) {
  plot::Series drawn{name, {}, {}, plot::Series::Style::line};
  for (std::size_t i = 0; i<curve.size(); i += curve.size()> 600 ? 10 : 1) {
    drawn.x.push_back(static_cast<double>(i + 1));
    drawn.y.push_back(curve[i]);
  }
  return drawn;
}

void reference_rows(Result& result) {
  const struct {
    const char* name;
    double expected;
    std::vector<double> curve;
  } cases[] = {
      {"Jacobi", 3495, curve_of(jacobi)},
      {"Gauss-Seidel, natural order", 1741, curve_of(natural)},
      {"Gauss-Seidel, red-black", 2094, curve_of(red_black)},
      {"Gauss-Seidel, symmetric", 869, curve_of(symmetric)},
      {"over-relaxed Gauss-Seidel", 125, curve_of(over_relaxed)},
      {"Chebyshev over Jacobi", 232, curve_of(jacobi, jacobi_radius)},
      {"Chebyshev over red-black", 199, curve_of(red_black, gauss_seidel_radius)},
      {"Chebyshev over red-black after 10", 116, curve_of(red_black, gauss_seidel_radius, 10)},
      {"Chebyshev over symmetric", 117, curve_of(symmetric, gauss_seidel_radius * gauss_seidel_radius)},
      {"Chebyshev over symmetric after 10", 66, curve_of(symmetric, gauss_seidel_radius * gauss_seidel_radius, 10)},
  };
  plot::Chart chart{"A free chain of 100 links: sweeps to a thousandth", "sweeps", "rms error [m]", true, true, {}};
  for (const auto& at : cases) {
    result.rows.push_back(relative("convergence: " + std::string(at.name), at.expected, sweeps_in(at.curve), 0.1,
                                   "sweeps", "to 1e-3 of the start; 100 links, free ends, in double"));
    chart.series.push_back(series(at.name, at.curve));
  }
  result.charts.push_back(chart);
  const std::vector<double> refused = curve_of(natural, gauss_seidel_radius);
  result.rows.push_back(relative("convergence: Chebyshev over natural order diverges", 1, refused.back() > 1e3 ? 1 : 0,
                                 0, "", "the reason why it is rejected; its residual grew more than a thousandfold"));
}

// ---- the engine

Scene chain_scene(Sweep sweep, const SweepOptions& options, int iterations) {
  std::vector<Vec3f> positions;
  std::vector<int> pairs;
  for (double x : start()) positions.push_back({static_cast<float>(x), 0, 0});
  for (int i = 0; i < string_links; ++i) pairs.insert(pairs.end(), {i, i + 1});
  Object object = particles(positions, std::vector<float>(string_links + 1, 1.f));
  connect(object, pairs, std::vector<float>(string_links, 1.f), Stiffness::rigid());
  Scene scene = scene_with(object, 0, 1, iterations);
  scene.settings.sweep = sweep;
  scene.settings.sweep_options = options;
  scene.settings.record_residuals = true;
  return scene;
}

double engine_sweeps(Sweep sweep, const SweepOptions& options, int iterations) {
  World world(chain_scene(sweep, options, iterations));
  const Report report = world.step(1.f / 60);
  for (const IterationResidual& at : report.convergence) {
    if (at.primal[0].rms < 1e-3 * report.convergence[0].primal[0].rms) return at.iteration;
  }
  return most_sweeps;
}

SweepOptions chebyshev(double rho, int plain) {
  SweepOptions options;
  options.acceleration = SweepOptions::Acceleration::chebyshev;
  options.spectral_radius = static_cast<float>(rho);
  options.plain_iterations = plain;
  return options;
}

double refusals() {
  try {
    World world(chain_scene(Sweep::natural, chebyshev(gauss_seidel_radius, 1), 10));
  } catch (const Error&) {
    return 1;
  }
  return 0;
}

void engine_rows(Result& result) {
  SweepOptions over;
  over.relaxation = static_cast<float>(2 / (1 + std::sin(pi / (string_links + 1))));
  const auto add = [&](const std::string& name, double expected, double measured) {
    result.rows.push_back(relative("convergence: engine, " + name, expected, measured, 0.1, "sweeps",
                                   "the same chain, float; its two colours are red and black"));
  };
  add("Gauss-Seidel, natural order", 1741, engine_sweeps(Sweep::natural, {}, 2500));
  add("Gauss-Seidel, red-black", 2094, engine_sweeps(Sweep::tiled, {}, 2500));
  // Two constraints share each inner particle, which halves every step, and therefore 1 - rho. The rate of Chebyshev
  // depends on the square root of that.
  add("Jacobi, half steps", 2 * 3495, engine_sweeps(Sweep::jacobi, {}, 9000));
  // Forward and backward over two colours, each colour is visited twice in a row. The second visit changes nothing, so
  // a symmetric iteration equals one plain sweep.
  add("Gauss-Seidel, symmetric over red-black", 2094, engine_sweeps(Sweep::symmetric, {}, 2500));
  add("over-relaxed Gauss-Seidel", 125, engine_sweeps(Sweep::natural, over, 200));
  add("Chebyshev over Jacobi, half steps", std::sqrt(2.0) * 232,
      engine_sweeps(Sweep::jacobi, chebyshev((1 + jacobi_radius) / 2, 1), 500));
  SweepOptions whole = chebyshev(jacobi_radius, 1);
  whole.relaxation = 1.999f;
  add("Chebyshev over Jacobi, relaxation 1.999", 232, engine_sweeps(Sweep::jacobi, whole, 400));
  add("Chebyshev over red-black", 199, engine_sweeps(Sweep::tiled, chebyshev(gauss_seidel_radius, 1), 300));
  add("Chebyshev over red-black after 10", 116, engine_sweeps(Sweep::tiled, chebyshev(gauss_seidel_radius, 10), 300));
  const std::string note = "rho estimated; at most the sweeps of Chebyshev over Jacobi with known rho";
  result.rows.push_back(at_most("convergence: engine, Chebyshev over red-black, rho estimated", 232,
                                engine_sweeps(Sweep::tiled, chebyshev(0, 10), 400), "sweeps", note));
  result.rows.push_back(at_most("convergence: engine, Chebyshev over symmetric, rho estimated", 232,
                                engine_sweeps(Sweep::symmetric, chebyshev(0, 10), 400), "sweeps", note));
  result.rows.push_back(relative("convergence: engine refuses Chebyshev over natural order", 1, refusals(), 0, "",
                                 "a World throws an Error that says why"));
}

}  // namespace

void convergence_rows(Result& result, bool) {
  reference_rows(result);
  engine_rows(result);
}

}  // namespace pliant::validate
