// The residual of distance constraints during a substep, for Settings::tolerance.
//
// The residual decides the number of iterations, so its bits affect the result: every machine adds sixteen partial sums
// in the order of segments and tasks. It has no version for each instruction set level: compiled for baseline x86-64 it
// costs about two sweeps, and it runs only if a tolerance is set.
#pragma once

#include <cstdint>
#include <vector>

#include "model/phase.h"

namespace pliant {

struct Model;
struct Substep;

/// The tasks of the sum, and their results.
struct ResidualScratch {
  std::vector<Task> tasks;       ///< an object, and one of its LengthRanges
  std::vector<double> squares;   ///< sum of squared residuals, one per task [m^2]
  std::int64_t constraints = 0;  ///< number of constraints of all tasks
};

/// Assigns the segments of all objects to tasks.
void prepare_residual(const Model& model, ResidualScratch& scratch);

/// Returns the root mean square of C + alpha~ lambda over all distance constraints [m]; infinity if there are none.
/// Call it after the first sweep of a substep.
double distance_residual(Substep& s);

}  // namespace pliant
