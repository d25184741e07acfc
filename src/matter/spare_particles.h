// Particles of an object that are not there yet.
#pragma once

#include "pliant/scene.h"

namespace pliant {

/// Adds particles at the first emitter until the object has `capacity` of them, and sets Flow::spare. 0: adds none.
/// Throws an Error if the capacity is negative, above 2^26, or less than the particles at the start.
void add_spare(int capacity, Object& object);

}  // namespace pliant
