// How far distance constraints are from met in the midst of a substep: what Settings::tolerance stops iterations by.
//
// The result decides how many iterations are made, so its bits are part of the result: sixteen sums side by side whatever the
// machine has, added segment by segment and task by task. Not a kernel of each instruction set: one pass in what every
// x86-64 has costs about two plain sweeps, and is made only where a tolerance is set.
#pragma once

#include <cstdint>
#include <vector>

namespace pliant {

struct Substep;
struct Model;

/// Stretches of segments, cut by the model alone, and room for the sum over each.
struct ResidualScratch {
  struct Task {
    std::int32_t object, first, last;  ///< segments, half open; not all of them of distances
    std::int32_t batches;
  };
  std::vector<Task> tasks;
  std::vector<double> squares;   ///< sum of the squared residuals, one a task [m^2]
  std::int64_t constraints = 0;  ///< of all tasks
};

/// Finds the segments of all objects.
void prepare_residual(const Model& model, ResidualScratch& scratch);

/// Root mean square of |C + alpha~ lambda| over all distance constraints as they are now [m]; infinity where there are none.
/// After the first sweep of a substep.
double distance_residual(Substep& s);

}  // namespace pliant
