// One frame: how a World moves.
#pragma once

#include <atomic>

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
  SweepOptions options{};
  bool record_residuals = false;
  const std::atomic<bool>* stop = nullptr;  ///< where it is true, the frame ends with the substep under way
  bool separate_phases = false;             ///< of Settings
  double tolerance = 0;                     ///< of Settings; above 0 the workspace comes from prepare_residual too
};

/// Advances the state by dt. Never throws; what went wrong is in the report.
void step(const StepContext& context, double dt, Report& report);

}  // namespace pliant
