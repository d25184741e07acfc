#include "solver/forces.h"
#include "solver/gases/gas_solver.h"
#include "solver/stages/stages.h"

namespace pliant {

void apply_forces(Substep& s) {
  if (s.gases != nullptr) s.gases->bear_up(s);
  if (!has_forces(s.model, s.work.control)) return;
  apply_forces(
      s.model, s.state, s.work, s.context.executor, time_of(s, s.number), s.h,
      [&](int object) { return gravity_for(s, s.work.gravity[object].settled); },
      [&](FunctionRef<void(int)> body) { for_objects(s, body); }, [&](int object) { return takes_part(s, object); },
      s.report.warnings);
}

}  // namespace pliant
