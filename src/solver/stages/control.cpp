#include "solver/stages/stages.h"

namespace pliant {

void control(Substep& s) {
  s.time_after = time_of(s, s.number + 1);
  move_colliders(s.model, s.work.control, time_of(s, s.number), s.time_after, s.own->colliders);
}

}  // namespace pliant
