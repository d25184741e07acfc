// The driver of volume constraints, for all objects of a phase at once (solver/volume.h).
#include "solver/volume.h"

#include "solver/drivers/driver.h"

namespace pliant {

void project_volumes(Substep& s, const Phase& /*phase*/, const Pass& pass) {
  const auto of_object = [&](int object) { return arguments(s, object, pass.first); };
  std::vector<int> tasks;
  for_each_tile(s, [&](int task) {
    const int object = s.model.tiles()[task].object;
    if (s.model.objects[object].has_volume && is_swept(s, object)) tasks.push_back(task);
  });
  project_volumes(s.model, s.work, s.context.executor, of_object, tasks);
}

}  // namespace pliant
