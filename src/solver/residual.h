// The residual of distance constraints during a substep, for Settings::tolerance.
//
// The residual decides the number of iterations, so its bits affect the result: sixteen
// sums on every machine, added by segment and task. It is no kernel per instruction set:
// one pass in baseline x86-64 costs about two plain sweeps, and runs only with a tolerance.
#pragma once

#include <cstdint>
#include <vector>

namespace pliant {

struct Substep;
struct Model;

/// Ranges of segments, which depend on the model alone, and their sums.
struct ResidualScratch {
  struct Task {
    std::int32_t object, first, last;  ///< segments, half-open; not all are distances
    std::int32_t batches;
  };
  std::vector<Task> tasks;
  std::vector<double> squares;   ///< sum of squared residuals, one per task [m^2]
  std::int64_t constraints = 0;  ///< number of constraints of all tasks
};

/// Collects the segments of all objects.
void prepare_residual(const Model& model, ResidualScratch& scratch);

/// Root mean square |C + alpha~ lambda| of all distance constraints at present
/// [m]; infinity if there are none. Call it after the first sweep of a substep.
double distance_residual(Substep& s);

}  // namespace pliant
