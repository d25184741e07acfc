#include "solver/stages/stages.h"

namespace pliant {

void respond(Substep& s) {
  if (!s.has_pairs()) return;
  const float slow = 2 * length(s.model.gravity) * s.h;
  s.work.pairs->respond(s.state.positions.data(), s.state.velocities.data(), slow,
                        [&](int object) { return s.is_last() ? Vec3f{} : gravity_for(s, s.work.gravity[object].settled); });
}

}  // namespace pliant
