#include "model/changing_rest.h"
#include "solver/collider_depenetration.h"
#include "solver/stages/stages.h"

namespace pliant {

void control(Substep& s) {
  s.time_after = time_of(s, s.number + 1);
  move_colliders(s.model, s.work.control, time_of(s, s.number), s.time_after, s.own->colliders);
  find_points_inside(s);
  if (s.context.changing != nullptr)
    for_objects(s, [&](int o) {
      follow_keyframes((*s.context.changing)[static_cast<std::size_t>(o)], s.state, o, s.time_after);
    });
  for_systems(s, [&](System& system) { system.control(s); });
}

}  // namespace pliant
