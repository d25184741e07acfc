// How a solve converges, iteration by iteration: both residuals of XPBD's equations (Macklin et al. 2016, eq. 8 and 9).
//
// A looking glass, not a part of the solve: it changes nothing, works in double, one thread, and allocates as it likes.
#pragma once

namespace pliant {

struct Substep;

/// Keeps the prediction, from which the dual residual is measured, and reports iteration 0. Before the first sweep of a
/// substep.
void record_prediction(Substep& s);

/// Appends the residuals after iteration number `iteration`, from 1, to the report.
void record_iteration(Substep& s, int iteration);

}  // namespace pliant
