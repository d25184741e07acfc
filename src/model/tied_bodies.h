// Bodies that many ties hold: the ties of one body are projected together (solver/bodies/tied_body.h).
#pragma once

#include <vector>

#include "model/gather_constraints.h"

namespace pliant {

/// The ties of one body, as indices into a list.
using TiesOfBody = std::vector<int>;

struct TiedBodies {
  std::vector<std::vector<TiesOfBody>> colours;  ///< bodies of one colour share no particle, centres included
  std::vector<int> singles;                      ///< the other ties, ascending
};

/// Finds the bodies with at least three ties, which hold it at more than a hinge. A second tie of a particle to the
/// same body is single.
TiedBodies find_tied_bodies(const ConstraintList& ties, int particles);

}  // namespace pliant
