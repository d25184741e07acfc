// The driver of density constraints, for all liquids of a group at once (solver/fluids/fluid_solver.h).
#include "solver/fluids/fluid_solver.h"

#include "solver/drivers/driver.h"

namespace pliant {

void project_fluids(Substep& s, const Phase& /*phase*/, const Pass& pass) {
  if (s.fluids != nullptr) s.fluids->project(s, pass.first);
}

}  // namespace pliant
