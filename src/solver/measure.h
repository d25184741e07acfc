// Measures constraint errors: read-only passes over a State.
#pragma once

#include <vector>

#include "model/model.h"
#include "pliant/report.h"
#include "solver/workspace.h"

namespace pliant {

/// Measures |C + alpha~ lambda| of every constraint, by type in the order of AllConstraints, volumes last. Multipliers
/// that are not stored count as zero; `h` is the length of their substep [s].
std::vector<Residual> measure_residuals(const Model& model, const State& state, const Workspace& workspace,
                                        FunctionRef<float(int)> h);

/// The results of measure_lengths, with its scratch memory, which is kept so that only the first frame allocates.
struct Lengths {
  Stretch stretch;          ///< stretch of all distance constraints with a rest length
  Overstretch overstretch;  ///< excess stretch of those without PBD stiffness; uses multipliers and h as measure_residuals
  std::vector<float> ratios, excesses;
};

/// Measures all distance constraints that have a rest length.
void measure_lengths(const Model& model, const State& state, const Workspace& workspace, FunctionRef<float(int)> h,
                     Lengths& lengths);

/// The volume that an object's triangles enclose [m^3].
double measure_volume(const CompiledObject& object, const Record* positions);

}  // namespace pliant
