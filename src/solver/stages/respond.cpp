#include "solver/stages/stages.h"

namespace pliant {

void respond(Substep& s) {
  if (!s.has_pairs()) return;
  const float slow = 2 * length(s.model.gravity) * s.h;
  const auto gravity = [&](int object) { return s.is_last() ? Vec3f{} : gravity_for(s, s.work.gravity[object].settled); };
  Record* velocities = s.state.velocities.data();
  s.work.contact_solver.for_each(s.executor, "respond", s.work.pairs->contacts(), [&](const Contact& contact) {
    s.work.pairs->end_impact(contact, s.state.positions.data(), velocities, gravity);
  });
  s.work.contact_solver.for_each(s.executor, "respond", s.work.pairs->contacts(), [&](const Contact& contact) {
    s.work.pairs->respond(contact, s.state.positions.data(), velocities, slow, gravity);
  });
  s.work.pairs->limit_untangling(velocities, gravity);
}

}  // namespace pliant
