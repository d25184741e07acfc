// How well the constraints are met: read-only passes over a state.
#pragma once

#include <vector>

#include "model/model.h"
#include "pliant/world.h"
#include "solver/workspace.h"

namespace pliant {

/// |C + alpha~ lambda| of every constraint, by type in the order of AllConstraints, volumes last. Multipliers count where
/// they were kept; `h` is the substep they belong to [s].
std::vector<Residual> measure_residuals(const Model& model, const State& state, const Workspace& workspace, float h);

/// Length over rest length of all distance constraints with a rest length.
Stretch measure_stretch(const Model& model, const State& state);

/// Enclosed volume of an object's triangles [m^3].
double measure_volume(const CompiledObject& object, const Record* positions);

}  // namespace pliant
