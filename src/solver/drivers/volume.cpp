// The driver of volume constraints, for all objects of a phase at once (solver/volume.h).
#include "solver/volume.h"

#include "solver/drivers/driver.h"

namespace pliant {

void project_volumes(Substep& s, const Phase& /*phase*/, const Pass& pass) {
  const auto of_object = [&](int object) { return arguments(s, object, pass.first); };
  const auto takes_part = [&](int object) { return s.model.objects[object].has_volume && is_swept(s, object); };
  project_volumes(s.model, s.work, s.context.executor, of_object, takes_part);
}

}  // namespace pliant
