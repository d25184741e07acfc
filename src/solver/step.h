// Advances a World by one frame.
#pragma once

#include <atomic>
#include <span>

#include "model/model.h"
#include "parallel/executor.h"
#include "pliant/report.h"
#include "solver/convergence_meter.h"
#include "solver/kernels.h"
#include "solver/overstretch_meter.h"
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
  int substeps = 1;  ///< substeps per frame of all objects if `groups` is empty
  int iterations = 1;
  SweepOptions options{};
  bool record_residuals = false;
  const std::atomic<bool>* stop = nullptr;  ///< stop request: the frame ends as soon as all groups reach one time
  bool separate_phases = false;             ///< Settings::separate_phases
  double tolerance = 0;  ///< Settings::tolerance; if > 0, call prepare_residual first, and use one group
  std::span<const GroupFrame> groups{};  ///< groups with different numbers of substeps
  OverstretchMeter* meter = nullptr;     ///< fills Report::overstretch if the frame is completed; null: not measured
  SleepOptions sleep{};                  ///< Settings::sleep
  bool keeps_energy = false;             ///< Settings::integrator is `energy`
  /// The objects of `model`, whose rest data and pressures substeps change; null: none has any that change.
  std::vector<CompiledObject>* changing = nullptr;
  ConvergenceMeter* estimator = nullptr;  ///< estimates the frame if it is completed; null: not estimated
};

/// Advances the State by `dt` seconds. Never throws; the report describes all problems.
void step(const StepContext& context, double dt, Report& report);

}  // namespace pliant
