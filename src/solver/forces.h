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

/// Force of air on a triangle [N]: with u the air's velocity relative to it, n its normal turned into the stream, A its
/// area,
///   drag  rho/2 A c_drag (u . n) u,      lift  rho/2 A c_lift (u . n) |u| (n - u (u . n)/|u|^2),
/// as for a flat plate: nothing along the stream when edge on. `response` is 2 h times the mean inverse mass of its
/// corners; the force is divided by 1 + response |f| / |u|, since no drag can do more in a step than stop the relative
/// motion.
Vec3f air_force(const Vec3f (&x)[3], const Vec3f& relative_velocity, float air_density, float drag, float lift,
                float response);

}  // namespace pliant
