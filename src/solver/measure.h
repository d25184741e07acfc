// Measures constraint errors: read-only passes over a State.
#pragma once

#include <vector>

#include "model/model.h"
#include "pliant/report.h"
#include "solver/workspace.h"

namespace pliant {

/// |C + alpha~ lambda| of every constraint, by type in the order of AllConstraints, volumes last. Multipliers count if they
/// are stored; `h` is the length of their substep [s].
std::vector<Residual> measure_residuals(const Model& model, const State& state, const Workspace& workspace,
                                        FunctionRef<float(int)> h);

/// The results of measure_lengths and its scratch memory, kept so that only the first frame allocates.
struct Lengths {
  Stretch stretch;          ///< of all distance constraints with a rest length
  Overstretch overstretch;  ///< of the same except PBD ones; multipliers and h as in measure_residuals
  std::vector<float> ratios, excesses;
};

/// Measures all distance constraints with a rest length.
void measure_lengths(const Model& model, const State& state, const Workspace& workspace, FunctionRef<float(int)> h,
                     Lengths& lengths);

/// Enclosed volume of an object's triangles [m^3].
double measure_volume(const CompiledObject& object, const Record* positions);

}  // namespace pliant
