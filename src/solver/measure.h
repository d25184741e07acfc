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

/// Measures all distance constraints that have a rest length. `ratios` is scratch memory.
Stretch measure_stretch(const Model& model, const State& state, std::vector<float>& ratios);

/// The volume that an object's triangles enclose [m^3].
double measure_volume(const CompiledObject& object, const Record* positions);

}  // namespace pliant
