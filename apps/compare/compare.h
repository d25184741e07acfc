// Compares sweeps on one scene: how fast each reduces the residual of the same substep, and what stretch each reaches
// in the same time per frame.
//
// Whole runs cannot be compared iteration by iteration, because their motions differ after a few frames. So the scene
// is simulated to some frame with its own settings; from that State every sweep solves the next substep with 1, 2, 3
// and more iterations.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/command_line/figure.h"
#include "apps/command_line/sweep_names.h"
#include "apps/plot/chart.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::compare {

using command::figure;
using command::Method;
using command::method_of;

/// The name of the sweep and substeps that a scene has if it leaves them open.
inline constexpr const char* default_name = "default";

/// The methods compared by default: all sweeps but `sequential`, which has the bits of `tiled`; the default sweep with
/// Chebyshev; and with tethers if the scene has fixed points.
std::vector<std::string> default_methods(const Scene& scene);

/// What a substep has reached after a number of iterations.
struct Sample {
  int iterations = 0;
  double milliseconds = 0;  ///< time of the whole substep, the least of several runs [ms]
  double residual = 0;      ///< root mean square of C + alpha~ lambda for the curve's constraint type, in the unit of C
  Stretch stretch;
  /// True if `milliseconds` are those of the next substep, because the first one after a restore rebuilds lists.
  bool of_next = false;
};

/// How one method converges in the substep.
struct Curve {
  std::string name;
  std::vector<IterationResidual> record;  ///< residuals after each iteration; the first entry is the prediction
  std::vector<double> residuals;          ///< residuals of the type that is plotted
  std::vector<Sample> samples;  ///< measurements after some numbers of iterations, with the first and the last
};

/// The best result that one method reaches within the time budget.
struct Budgeted {
  std::string name;
  int substeps = 0;         ///< within the budget those with the smallest `worst.p99`; of the default the mean
  int iterations = 0;       ///< likewise
  double milliseconds = 0;  ///< median time of a frame [ms]
  Stretch worst;            ///< largest of each figure over all frames
  Stretch last;             ///< stretch after the last frame
};

/// A method that could not be compared, and why.
struct Refusal {
  std::string name, reason;
};

struct Options {
  std::vector<std::string> methods;  ///< names of methods; empty: the default and default_methods()
  int frame = -1;        ///< number of frames before the substep that is compared; -1: half of the scene's frames
  int substeps = 0;      ///< substeps per frame, which set the length of that substep; 0: the scene's own
  int iterations = 100;  ///< largest number of iterations of the curves, 1..10000
  double budget = 0;     ///< time per frame [ms]; 0: measure only the curves
  std::function<void()> pause;  ///< called between measurements; may throw
};

struct Result {
  int frame = 0, iterations = 0, frames = 0;
  double substep = 0;         ///< length of the substep that is compared [s]
  double speed = 0;           ///< root mean square speed of all particles of finite mass before it [m/s]
  double budget = 0;          ///< time per frame [ms]
  std::string by_default;     ///< sweep and substeps that the scene has if it leaves them open, in words
  std::string residual_type;  ///< constraint type of Sample::residual: "distance" if the scene has distance constraints
  std::vector<Curve> curves;
  std::vector<Budgeted> budgeted;  ///< first the default, which takes the time that its substeps need
  std::vector<Refusal> refused;
};

/// Makes all measurements. Throws an Error if a method is unknown, if the scene is invalid or does not stay finite up
/// to the frame, or if no method can be compared.
Result run(const Scene& scene, const Options& options);

/// Copies the motion of `from` to `to`, a World of the same scene with other settings: each sweep has its own order of
/// particles. Both reset their multipliers. The last `collider_particles` particles of each State belong to mesh
/// colliders.
void take_state(World& to, World& from, std::size_t collider_particles = 0);

/// By how much a ratio exceeds 1, in percent.
inline double percent(double ratio) { return 100 * (ratio - 1); }

/// Six panels: residual, largest stretch and its 99th percentile, each over iterations and over milliseconds.
std::vector<plot::Chart> to_charts(const Result& result);
std::string to_table(const Result& result);
std::string to_json(const Result& result);

// ---------------------------------------------------------------- the parts of run

/// True if the next substep is timed instead of the one that is solved (Sample::of_next).
bool times_next(const Result& result);

/// The length of the substep that is compared [s].
double substep_of(const Scene& scene, const Options& options);

/// Measures the curves of one method from the State of `start`. Throws an Error if the method rejects the scene or
/// diverges.
Curve measure_curve(const Scene& scene, World& start, const Method& method, const Options& options);

/// Times a curve's runs again, and keeps the lower times.
void time_again(const Scene& scene, World& start, const Method& method, const Options& options, Curve& curve);

/// A run contains all shorter runs, so its time is an upper bound of theirs. Lowers the time of each sample to that of
/// any sample with more iterations.
void lower_to_longer_runs(std::vector<Sample>& samples);

/// The time of the substep with a number of iterations, interpolated linearly between samples [ms].
double milliseconds_at(const Curve& curve, int iterations);

/// Runs all frames with the default sweep and substeps. Throws an Error if a value is not finite.
Budgeted run_default(const Scene& scene, const Options& options);

/// Finds for several numbers of iterations how many substeps fit into the budget, and returns the best. Throws an Error
/// with the reason if none fits or stays finite.
Budgeted fit_budget(const Scene& scene, const Method& method, const Options& options);

}  // namespace pliant::compare
