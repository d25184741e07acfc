// One scene under several sweeps, side by side: how fast each brings down the error of one and the same substep, and what
// stretch each is left with when all of them get the same milliseconds a frame.
//
// Whole runs can't be compared iteration by iteration: after a few frames each sweep is somewhere else. So the scene is run to
// one frame by its own settings, and from that very state every sweep solves the one substep that comes next, with 1, 2, 3 and
// more iterations.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/plot/chart.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::compare {

/// A sweep with its options, and what it is called on the command line: "chains", "tiled+chebyshev".
struct Method {
  std::string name;
  Sweep sweep = Sweep::tiled;
  SweepOptions options;
};

/// What may follow a sweep's name after a plus sign: "tethers", "chebyshev", "average".
std::vector<std::string> option_names();

/// The method of this name; what the name does not say is as in `base`. Throws Error that lists what there is.
Method method_of(const std::string& name, const SweepOptions& base);

/// Names compared unless told otherwise: every sweep there is but `sequential`, which has the bits of `tiled`, then Chebyshev
/// over the default, and tethers where something of the scene is fixed to hold them.
std::vector<std::string> default_methods(const Scene& scene);

/// Where a substep stands after so many iterations.
struct Sample {
  int iterations = 0;
  double milliseconds = 0;  ///< of the whole substep, the fastest of several; never less than with fewer iterations
  double residual = 0;      ///< root mean square of |C + alpha~ lambda| of the curve's type, in the unit of C
  Stretch stretch;
  bool of_next =
      false;  ///< `milliseconds` are of the substep after it: surfaces meet, and the first lists their pairs anew
};

/// One method's way through the substep.
struct Curve {
  std::string name;
  std::vector<IterationResidual> record;  ///< after every iteration, from 0, the prediction
  std::vector<double> residuals;          ///< the same of the one type that is drawn
  std::vector<Sample> samples;            ///< at some numbers of iterations, 1 and the last among them
};

/// What one method reaches within the budget.
struct Budgeted {
  std::string name;
  int substeps = 0, iterations = 0;  ///< of what was tried and fits, the one whose `worst` stretch is least at p99
  double milliseconds = 0;           ///< a frame, the median
  Stretch worst;                     ///< largest of all frames, each figure by itself
  Stretch last;                      ///< after the last frame
};

/// A method that was left out, and why.
struct Refusal {
  std::string name, reason;
};

struct Options {
  std::vector<std::string> methods;  ///< empty: default_methods()
  int frame = -1;                    ///< frames before the substep of the curves; -1: half of the scene's
  int substeps = 0;                  ///< a frame, of the curves' substep alone; 0: the scene's own
  int iterations = 100;              ///< the most of the curves, 1..10000
  double budget = 0;                 ///< milliseconds a frame; 0: curves alone
  std::function<void()> pause;       ///< called between measurements; what it throws passes through
};

struct Result {
  int frame = 0, iterations = 0, frames = 0;
  double substep = 0;         ///< of the curves [s]
  double budget = 0;          ///< milliseconds a frame
  std::string residual_type;  ///< of Sample::residual: "distance" where the scene has any
  std::vector<Curve> curves;
  std::vector<Budgeted> budgeted;
  std::vector<Refusal> refused;
};

/// Measures. Throws Error where a method is unknown, the scene is wrong or does not stay finite up to the frame, or every
/// method was refused.
Result run(const Scene& scene, const Options& options);

/// `to` gets the motion of `from`, a World of the same scene with other settings: sweeps number particles as suits them. Both
/// forget their multipliers. The last `collider_particles` of either State are those of mesh colliders.
void take_state(World& to, World& from, std::size_t collider_particles = 0);

/// So many digits, or all before the point where those are more: "0.00834", "118", "12345", and no powers of ten before 1e15.
std::string figure(double value, int digits);

/// Six panels: residual, largest stretch and its 99th percentile, each against iterations and against milliseconds.
std::vector<plot::Chart> to_charts(const Result& result);
std::string to_table(const Result& result);
std::string to_json(const Result& result);

// ---------------------------------------------------------------- the parts of run

/// Whether what was timed is the substep after the one that is solved (see Sample::of_next).
bool times_next(const Result& result);

/// The length of the curves' substep [s].
double substep_of(const Scene& scene, const Options& options);

/// Curves of one method from the state of `start`. Throws Error where it refuses the scene or does not stay finite.
Curve measure_curve(const Scene& scene, World& start, const Method& method, const Options& options);

/// Takes the times of a curve of this method once more, and keeps the lower ones.
void time_again(const Scene& scene, World& start, const Method& method, const Options& options, Curve& curve);

/// A run contains every shorter one, so that what it took bounds what they take: where a time falls from one sample to the
/// next, the earlier ones come down to it.
void lower_to_longer_runs(std::vector<Sample>& samples);

/// Of the substep with so many iterations, between the samples on a straight line: an iteration costs what another does [ms].
double milliseconds_at(const Curve& curve, int iterations);

/// The best of some numbers of iterations, with as many substeps as fit. Throws Error where none fits, or none of those that
/// do stays finite, and says which.
Budgeted fit_budget(const Scene& scene, const Method& method, const Options& options);

}  // namespace pliant::compare
