// One frame: how a World moves.
#pragma once

#include "model/model.h"
#include "parallel/executor.h"
#include "pliant/report.h"
#include "solver/kernels.h"
#include "solver/workspace.h"

namespace pliant {

/// Everything that a step works with.
struct StepContext {
  const Model& model;
  State& state;
  Workspace& workspace;
  Executor& executor;
  const Kernels& kernels;
  int substeps = 1, iterations = 1;
  Sweep sweep = Sweep::tiled;  ///< with any of these, the workspace comes from prepare_sweep too
  SweepOptions options{};
  bool record_residuals = false;
  double tolerance = 0;  ///< of Settings; above 0 the workspace comes from prepare_residual too
};

/// Advances the state by dt. Never throws; what went wrong is in the report.
void step(const StepContext& context, double dt, Report& report);

}  // namespace pliant
