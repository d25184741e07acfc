// Surface velocities: how fast the surface of a belt or track moves along itself while its shape stays, for what
// touches it.
#pragma once

#include "model/control.h"
#include "model/model.h"

namespace pliant {

/// That of a primitive collider in its own frame: the one that the user has set, else the one described [m/s].
Vec3f surface_velocity_of_collider(const Model& model, const Control& control, int collider);

/// That of a mesh collider, in world axes at a time. Its own frame is that of its motion or the pose that the user has
/// set.
Vec3f surface_velocity_of_mesh(const Model& model, const Control& control, int object, double time);

/// That of a body in its principal axes.
Vec3f surface_velocity_of_body(const Model& model, const Control& control, int object, int body);

/// True if some mesh collider has one.
bool some_meshes_slide(const Model& model, const Control& control);

}  // namespace pliant
