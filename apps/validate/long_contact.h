// Long contact scenes at their documented sizes, and their rows.
#pragma once

#include "apps/validate/audit.h"
#include "apps/validate/validate.h"

namespace pliant::validate {

/// A square sheet, folded over itself in a half circle, that falls on the ground.
Scene folded_scene(int side);
/// Ten square sheets of 0.72 m, each rotated by 9 degrees against the one below, that fall on a ball.
Scene layered_scene(int side);
/// A sheet four times as long as wide, 2 `side` by `side` / 2 vertices. Its ends rotate against each other, two turns
/// in eight seconds, and approach by a tenth of its length, as inextensible cloth must.
Scene twisted_scene(int side);
/// A ball of triangles that moves at 10 m/s, back and forth through a hanging square sheet.
Scene ball_scene(int side);
/// An open trefoil knot of rope whose ends are pulled apart in four seconds.
Scene knot_scene();

/// Adds the rows of these scenes, 600 frames each, which take minutes of processor time.
void long_contact_rows(Result& result);

}  // namespace pliant::validate
