// The form of a grain of sand.
#pragma once

#include "geometry.h"

namespace pliant::render {

/// Makes a ball of radius 1 a stone.
void make_uneven(Geometry& ball);

}  // namespace pliant::render
