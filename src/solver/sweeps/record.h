// Records how a solve converges from iteration to iteration: both residuals of XPBD (Macklin et al. 2016, eq. 8 and 9).
//
// For diagnosis only: it changes no state, computes in double precision on one thread, and may allocate.
#pragma once

namespace pliant {

struct Substep;

/// Stores the prediction, relative to which the dual residual is measured, and records iteration 0. Call it before the
/// first sweep of a substep.
void record_prediction(Substep& s);

/// Appends the residuals after iteration number `iteration` (first: 1) to the report.
void record_iteration(Substep& s, int iteration);

}  // namespace pliant
