// External forces except gravity: aerodynamic forces, force fields, and forces that the user sets for a frame.
#pragma once

#include <string>
#include <vector>

#include "model/model.h"
#include "parallel/executor.h"
#include "pliant/state.h"
#include "solver/kernels.h"
#include "solver/workspace.h"

namespace pliant {

/// True if apply_forces would apply any force.
bool has_forces(const Model& model, const Control& control);

/// The objects of a substep: calls its argument for each.
using EachObject = FunctionRef<void(FunctionRef<void(int)>)>;

/// Adds h f / m to the velocity of every dynamic particle of the given objects. `gravity(object)` is the part of
/// gravity that velocities do not include yet [m/s]. `takes_part(object)` is true for the given objects. Non-finite
/// forces are skipped and named in `warnings`.
void apply_forces(const Model& model, const Kernels& kernels, State& state, Workspace& workspace, Executor& executor,
                  double time, float h, FunctionRef<Vec3f(int)> gravity, EachObject each,
                  FunctionRef<bool(int)> takes_part, std::vector<std::string>& warnings);

/// The wind's velocity at a time [m/s].
Vec3f wind_at(const Wind& wind, double time);

}  // namespace pliant
