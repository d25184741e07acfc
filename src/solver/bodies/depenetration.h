// Limits how fast contacts push bodies apart that overlap more than what presses them together explains.
//
// A contact is soft: an impulse that lasts makes it a certain depth deep (manifold_passes.h). Bodies that overlap at
// the start are deeper by far, and a contact as stiff as its depth would throw them apart: a tower of ten
// half-overlapping cubes flew up with 17 m/s, because the speeds of all its contacts add up. So in each frame a contact
// counts as deep as its kept impulses make it, and by a margin deeper that leads to the depenetration speed. Contacts
// that rest are never deeper than that. The impulses are part of the State, so nothing else has to be kept.
//
// Particles that press on a body or are tied to it move it after its contacts, in each substep. So its contacts must
// correct that, not only resist it, and are deeper by 1 / epsilon.
#pragma once

#include "solver/bodies/manifold_passes.h"

namespace pliant {

/// The speed at which a contact moves bodies apart that overlap at the start [m/s]; `size` is half of the smaller one's
/// thickness [m].
float depenetration_speed(float size);

/// What else may press bodies together.
enum class PressedBy { bodies, anything };

/// Limits the depths of a manifold for a frame with substeps of length h [s]. Where bodies overlap `others` at once,
/// they share the speed. Returns true if the deepest point was deeper.
bool limit_depths(const BodyMotion& a, const BodyMotion& b, float size, int others, PressedBy by, float h,
                  Manifold& manifold);

}  // namespace pliant
