// The ball about the centre of mass of a body inside one of its solids.
//
// Contacts are linear in a substep. What is hit at an end at 100 m/s turns by more than a radian in one, and its centre
// would go through a surface from which that linear motion lifts its corners. A ball about the centre of mass does not
// change as the body turns, so its contact holds whatever the spin.
#pragma once

#include "collision/bodies/body_part.h"

namespace pliant {

/// The radius of the largest ball about the centre of mass of its body that fits into a convex part; 0 if that centre
/// is outside, or if the part is this ball [m].
float inner_radius(const BodyPart& part);

/// That ball in place of the part.
BodyPart inner_ball(const BodyPart& part, float radius);

}  // namespace pliant
