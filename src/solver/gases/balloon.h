// The air around bears up closed surfaces that hold a lighter gas. Inside and outside, pressure falls with height by
// the density of each gas, so their difference pushes outwards by lift (-g . x). Over the whole surface this is lift V
// against gravity, exactly.
#pragma once

namespace pliant {

struct Substep;

/// Adds h f / m to the velocities of an object with Volume::lift.
void lift_balloon(Substep& s, int object);

}  // namespace pliant
