// Sand and gravel as particles.
#pragma once

#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Options of make_grains.
struct GrainsOptions {
  std::string name = "grains";
  Grains grains{};
  Vec3f velocity{};  ///< at the start [m/s]
  Flow flow{};       ///< how particles come and go; `spare` follows from the capacity
  int capacity = 0;  ///< most particles that are there at a time, up to 2^26; 0: those at the start
};

/// Makes grains with centres at given places, a diameter or more apart: fill_box of pliant/liquid.h gives such places. Each has the mass of
/// a solid sphere, and meets colliders at its radius, with the friction of the grains. Throws an Error that names an option that is out of range.
Object make_grains(const std::vector<Vec3f>& positions, const GrainsOptions& options = {});

}  // namespace pliant
