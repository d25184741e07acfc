#include "solver/stages/stages.h"

namespace pliant {

void collide(Substep& s) {
  if (!s.has_pairs()) return;
  s.work.pairs->detect(s.context.executor, all_particles(s));
  s.work.contact_solver.begin(s.kernels.contacts, s.work.pairs->contacts(), s.state.positions.data(),
                              s.state.positions.size());
}

}  // namespace pliant
