// The driver of contacts of grains, for all of a group at once (solver/grains/grain_solver.h).
#include "solver/grains/grain_solver.h"

#include "solver/drivers/driver.h"

namespace pliant {

void project_grains(Substep& s, const Phase& /*phase*/, const Pass& pass) {
  if (s.grains != nullptr) s.grains->project(s, pass.first);
}

}  // namespace pliant
