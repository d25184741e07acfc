// The sweep of a solid that attachments hold.
//
// An attachment that is projected before the constraints of its solid has no effect on how these move its particle, and
// one that is projected after them takes back what they moved it by: either way the particle yields by all that they
// move it in one pass, and a bar that attachments hold sags 1.1 to 1.3 times too far (docs/internals/solids.md). So the
// sweep has the spring of the attachment in the inertia of its particle. That is exact: with a spring of compliance
// a = alpha / h^2 a particle of inverse mass w moves as one of w a / (w + a), whose prediction is by w / (w + a) of
// the way nearer to the target. After the sweep this is undone, and the attachment is projected as any other
// constraint, which puts the particle back where the sweep left it and gives the attachment its multiplier.
#pragma once

#include <utility>
#include <vector>

#include "solver/substep.h"

namespace pliant {

/// True if the sweep of an object has the springs of its held particles in their inertia: where each constraint is
/// projected once.
bool sweeps_held(const Substep& s, int object);

/// Puts the springs of the held particles of a tile into their predictions.
void hold_particles(const Substep& s, int object, const Tile& tile);

/// While it lives, the held particles of an object in [first, last) have the inverse mass that their springs leave
/// them.
class HeldMasses {
 public:
  HeldMasses(const Substep& s, int object, int first, int last);
  HeldMasses(const Substep& s, int object, const Tile& tile)
      : HeldMasses(s, object, tile.first_particle, tile.last_particle) {}
  HeldMasses(HeldMasses&& other) noexcept = default;
  HeldMasses& operator=(HeldMasses&&) = delete;
  ~HeldMasses();

 private:
  Record* positions_ = nullptr;
  std::vector<std::pair<int, float>> before_;  ///< particles with their inverse masses
};

}  // namespace pliant
