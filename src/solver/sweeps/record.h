// Convergence of a solve by iteration: both residuals of XPBD (Macklin et al. 2016, eq. 8 and 9).
//
// Diagnostics only: changes no state, computes in double on one thread, and may allocate.
#pragma once

namespace pliant {

struct Substep;

/// Stores the prediction, from which the dual residual is measured, and
/// reports iteration 0. Call it before the first sweep of a substep.
void record_prediction(Substep& s);

/// Appends the residuals after iteration `iteration` (from 1) to the report.
void record_iteration(Substep& s, int iteration);

}  // namespace pliant
