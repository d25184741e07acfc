// What joints look like: threads, springs as coils, ropes over pulleys.
#pragma once

#include "io/write_frames.h"
#include "render.h"

namespace pliant::render {

/// Adds a tube for each joint that sets a distance of two anchors, and for the rope of each pulley, unless it is
/// broken. A spring is a coil, with the same number of turns at any length.
void add_joints(RenderScene& result, const Object& object, const output::FrameObject& shape, const ObjectView& view);

}  // namespace pliant::render
