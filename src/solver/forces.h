// External forces other than gravity: moving air on triangles, force fields, and forces given for a frame.
#pragma once

#include <string>
#include <vector>

#include "model/model.h"
#include "parallel/executor.h"
#include "pliant/state.h"
#include "solver/workspace.h"

namespace pliant {

/// Whether apply_forces has anything to do.
bool has_forces(const Model& model, const Control& control);

/// Adds h f / m to every free particle's velocity; `gravity(object)` is what the velocities do not hold yet. A force that
/// is not finite is left out and named in `warnings`.
void apply_forces(const Model& model, State& state, Workspace& workspace, Executor& executor, double time, float h,
                  FunctionRef<Vec3f(int)> gravity, std::vector<std::string>& warnings);

/// The wind's velocity at a time [m/s].
Vec3f wind_at(const Wind& wind, double time);

}  // namespace pliant
