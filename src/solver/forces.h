// External forces except gravity: air on triangles, force fields, and user forces of a frame.
#pragma once

#include <string>
#include <vector>

#include "model/model.h"
#include "parallel/executor.h"
#include "pliant/state.h"
#include "solver/workspace.h"

namespace pliant {

/// True if apply_forces has any effect.
bool has_forces(const Model& model, const Control& control);

/// Adds h f / m to the velocity of every dynamic particle of objects that take part; `gravity(object)` is the part not included in
/// velocities yet.
/// Non-finite forces are skipped and named in `warnings`.
void apply_forces(const Model& model, State& state, Workspace& workspace, Executor& executor, double time, float h,
                  FunctionRef<Vec3f(int)> gravity, FunctionRef<bool(int)> takes_part, std::vector<std::string>& warnings);

/// The wind's velocity at a time [m/s].
Vec3f wind_at(const Wind& wind, double time);

}  // namespace pliant
