// Particles of elastic solids that attachments hold.
#pragma once

#include <vector>

#include "pliant/scene.h"

namespace pliant {

struct CompiledObject;
struct ConstraintList;

/// A particle with one attachment, whose target is in its tile. Indices are places in storage.
struct HeldParticle {
  int particle = 0, target = 0;
  float compliance = 0;  ///< of the attachment [m/N]
};

/// The held particles of a solid. Its sweep knows the springs of their attachments (solver/drivers/held.h).
struct HeldParticles {
  std::vector<HeldParticle> particles;  ///< in ascending order
  int pool = -1;                        ///< that of their attachments
};

/// True if attachments of an object with these constraints are known to its sweep: those of elastic solids.
bool holds_particles(const Object& object, const std::vector<ConstraintList>& lists);

/// Puts targets into the tiles of their particles. `tile`: of each particle, then of each target.
void follow_held_particles(const Object& object, std::vector<int>& tile);

/// Finds the held particles of a compiled object. `tile`: as above.
HeldParticles find_held_particles(const Object& object, const std::vector<int>& tile, const CompiledObject& of);

}  // namespace pliant
