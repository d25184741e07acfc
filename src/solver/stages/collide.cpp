#include "solver/stages/stages.h"

namespace pliant {

void collide(Substep& s) {
  if (s.has_pairs()) s.work.pairs->detect(s.executor, all_particles(s));
}

}  // namespace pliant
