// Scenes that surfaces must come through whole, in the sizes of their promise, and their rows.
#pragma once

#include "apps/validate/audit.h"
#include "apps/validate/validate.h"

namespace pliant::validate {

/// A square sheet, folded back over itself in a half circle, falls on the ground.
Scene folded_scene(int side);
/// Ten square sheets of 0.72 m, each turned by 9 degrees against the one below, fall on a ball.
Scene layered_scene(int side);
/// A sheet four times as long as wide, 2 `side` by `side` / 2 vertices, whose two ends turn against one another, two turns in eight
/// seconds, and come nearer by a tenth of its length, as a thing that does not stretch must.
Scene twisted_scene(int side);
/// A ball of triangles at 10 m/s, to and fro through where a square sheet hangs.
Scene ball_scene(int side);
/// An open trefoil of rope, its ends drawn apart in four seconds.
Scene knot_scene();

/// Their rows: 600 frames each, minutes of processor time.
void long_contact_rows(Result& result);

}  // namespace pliant::validate
