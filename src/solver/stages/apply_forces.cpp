#include <algorithm>

#include "solver/forces.h"
#include "solver/stages/stages.h"

namespace pliant {

namespace {

/// Keeps velocities as they are before forces change them: dampers, and matter that keeps its motion, read those.
void keep_velocities(Substep& s) {
  s.work.velocities_before.resize(s.state.velocities.size());
  for_objects(s, [&](int object) {
    const auto first = s.state.velocities.begin() + s.model.first[object];
    std::copy_n(first, s.model.objects[object].particles, s.work.velocities_before.begin() + s.model.first[object]);
  });
}

}  // namespace

void apply_forces(Substep& s) {
  if (changes_velocities(s)) keep_velocities(s);
  for_systems(s, [&](System& system) { system.apply_forces(s); });
  if (!has_forces(s.model, s.work.control)) return;
  apply_forces(
      s.model, s.context.kernels, s.state, s.work, s.context.executor, time_of(s, s.number), s.h,
      [&](int object) { return gravity_for(s, s.work.gravity[object].settled); },
      [&](FunctionRef<void(int)> body) { for_objects(s, body); }, [&](int object) { return takes_part(s, object); },
      s.report.warnings);
}

}  // namespace pliant
