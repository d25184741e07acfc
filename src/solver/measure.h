// How well the constraints are met: read-only passes over a state.
#pragma once

#include <vector>

#include "model/model.h"
#include "pliant/report.h"
#include "solver/workspace.h"

namespace pliant {

/// |C + alpha~ lambda| of every constraint, by type in the order of AllConstraints, volumes last. Multipliers count where
/// they were kept; `h` is the substep they belong to [s].
std::vector<Residual> measure_residuals(const Model& model, const State& state, const Workspace& workspace, float h);

/// What measure_lengths has found, and the room it needs: kept, so that measuring each frame allocates once.
struct Lengths {
  Stretch stretch;          ///< of all distance constraints with a rest length
  Overstretch overstretch;  ///< of those but PBD; multipliers and h as in measure_residuals
  std::vector<float> ratios, excesses;
};

/// Measures all distance constraints with a rest length.
void measure_lengths(const Model& model, const State& state, const Workspace& workspace, float h, Lengths& lengths);

/// Enclosed volume of an object's triangles [m^3].
double measure_volume(const CompiledObject& object, const Record* positions);

}  // namespace pliant
