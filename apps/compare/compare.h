// Compares sweeps on one scene: how fast each reduces the error of the same
// substep, and the stretch that each reaches with equal milliseconds per frame.
//
// Whole runs cannot be compared by iteration, because the sweeps diverge after
// a few frames. So the scene runs to one frame with its own settings. From that
// State, every sweep solves the next substep with 1, 2, 3 and more iterations.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/plot/chart.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::compare {

/// A sweep with its options, and its name on the command line: "chains", "tiled+chebyshev".
struct Method {
  std::string name;
  Sweep sweep = Sweep::tiled;
  SweepOptions options;
};

/// Options that may follow a sweep's name after a plus sign: "tethers", "chebyshev", "average".
std::vector<std::string> option_names();

/// The method of this name; options not named are those of `base`. Throws an Error that lists the known names.
Method method_of(const std::string& name, const SweepOptions& base);

/// The default selection: every sweep except `sequential`, which has the bits of `tiled`; then Chebyshev over the default,
/// and tethers if the scene has fixed points to hold them.
std::vector<std::string> default_methods(const Scene& scene);

/// The state of a substep after a number of iterations.
struct Sample {
  int iterations = 0;
  double milliseconds = 0;  ///< time of the whole substep, the fastest of several; monotonic in iterations
  double residual = 0;      ///< root mean square |C + alpha~ lambda| of the curve's type, in the unit of C
  Stretch stretch;
  bool of_next =
      false;  ///< true if `milliseconds` are of the next substep, because the first one after a restore rebuilds its lists
};

/// The convergence of one method in the substep.
struct Curve {
  std::string name;
  std::vector<IterationResidual> record;  ///< residuals after every iteration, from 0, the prediction
  std::vector<double> residuals;          ///< the same for the plotted type
  std::vector<Sample> samples;            ///< measurements at some numbers of iterations, including 1 and the last
};

/// The best result of one method within the budget.
struct Budgeted {
  std::string name;
  int substeps = 0, iterations = 0;  ///< the combination within the budget whose `worst.p99` is smallest
  double milliseconds = 0;           ///< median of the milliseconds per frame
  Stretch worst;                     ///< maximum over all frames, for each figure separately
  Stretch last;                      ///< stretch after the last frame
};

/// A rejected method and the reason.
struct Refusal {
  std::string name, reason;
};

struct Options {
  std::vector<std::string> methods;  ///< empty: default_methods()
  int frame = -1;                    ///< frames before the curves' substep; -1: half of the scene's
  int substeps = 0;                  ///< substeps per frame, for the curves' substep only; 0: the scene's own
  int iterations = 100;              ///< maximum of the curves, 1..10000
  double budget = 0;                 ///< milliseconds per frame; 0: curves only
  std::function<void()> pause;       ///< called between measurements; its exceptions pass through
};

struct Result {
  int frame = 0, iterations = 0, frames = 0;
  double substep = 0;         ///< length of the curves' substep [s]
  double budget = 0;          ///< milliseconds per frame
  std::string residual_type;  ///< constraint type of Sample::residual: "distance" if the scene has any
  std::vector<Curve> curves;
  std::vector<Budgeted> budgeted;
  std::vector<Refusal> refused;
};

/// Runs all measurements. Throws an Error if a method is unknown, the scene is
/// invalid or does not stay finite up to the frame, or all methods are rejected.
Result run(const Scene& scene, const Options& options);

/// Copies the motion of `from` into `to`, a World of the same scene with other settings: each sweep has its own particle
/// order. Both reset their multipliers. The last `collider_particles` of either State belong to mesh colliders.
void take_state(World& to, World& from, std::size_t collider_particles = 0);

/// At least `digits` significant digits, all before the point: "0.00834", "118", "12345"; no exponent below 1e15.
std::string figure(double value, int digits);

/// Six panels: residual, largest stretch and its 99th percentile, each over iterations and over milliseconds.
std::vector<plot::Chart> to_charts(const Result& result);
std::string to_table(const Result& result);
std::string to_json(const Result& result);

// ---------------------------------------------------------------- the parts of run

/// True if the timed substep is the one after the solved one (see Sample::of_next).
bool times_next(const Result& result);

/// The length of the curves' substep [s].
double substep_of(const Scene& scene, const Options& options);

/// Measures the curves of one method from the state of `start`. Throws an Error if it rejects the scene or diverges.
Curve measure_curve(const Scene& scene, World& start, const Method& method, const Options& options);

/// Repeats the timings of a curve and keeps the lower ones.
void time_again(const Scene& scene, World& start, const Method& method, const Options& options, Curve& curve);

/// A run contains every shorter one, so its time is an upper bound of theirs.
/// Where a time falls from one sample to the next, earlier ones are lowered to it.
void lower_to_longer_runs(std::vector<Sample>& samples);

/// Time of the substep with so many iterations, linearly interpolated between samples [ms].
double milliseconds_at(const Curve& curve, int iterations);

/// The best of several numbers of iterations, each with as many substeps as
/// fit. Throws an Error that gives the reason if none fits or stays finite.
Budgeted fit_budget(const Scene& scene, const Method& method, const Options& options);

}  // namespace pliant::compare
