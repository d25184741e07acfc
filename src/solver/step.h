// Advances a World by one frame.
#pragma once

#include <atomic>
#include <span>

#include "model/model.h"
#include "parallel/executor.h"
#include "pliant/report.h"
#include "solver/kernels.h"
#include "solver/substep_group.h"
#include "solver/workspace.h"

namespace pliant {

/// The inputs of a step.
struct StepContext {
  const Model& model;
  State& state;
  Workspace& workspace;
  Executor& executor;
  const Kernels& kernels;
  int substeps = 1;  ///< substeps of all objects if `groups` is empty
  int iterations = 1;
  SweepOptions options{};
  bool record_residuals = false;
  const std::atomic<bool>* stop = nullptr;  ///< if true, the frame ends when all groups reach one time
  bool separate_phases = false;             ///< as in Settings
  double tolerance = 0;                     ///< from Settings; above 0 it needs prepare_residual, and one group
  std::span<const GroupFrame> groups{};     ///< groups with different substeps
};

/// Advances the State by dt. Never throws; the report has all problems.
void step(const StepContext& context, double dt, Report& report);

}  // namespace pliant
