// What the sweeps keep between the passes of a substep. Nothing of it outlives a substep: a State put back gives the same
// bits.
#pragma once

#include <vector>

#include "model/model.h"
#include "solver/sweeps/incidence.h"
#include "solver/sweeps/multigrid.h"

namespace pliant {

/// One float a lane for each pool, as Workspace::multipliers has them: [object][pool].
using LaneValues = std::vector<std::vector<AlignedVector<float>>>;

/// The Jacobi sweep of one object.
struct JacobiObject {
  Incidence incidence;
  Records corrections;                       ///< of every constraint's particles, pool after pool
  std::vector<Record*> correction_pointers;  ///< one a pool
  std::vector<AlignedVector<float>> shares;  ///< one a lane: see Incidence::shares; where corrections are averaged
  std::vector<const float*> share_pointers;
  Records positions;  ///< with w times the particle's constraints; where masses are split
};

/// Chebyshev acceleration: the last two iterates, and where its recurrence stands in this substep.
struct ChebyshevScratch {
  Records before, older;  ///< x_k and x_(k-1), as displacements
  LaneValues multipliers_before, multipliers_older;
  std::vector<double> volumes_before, volumes_older;
  std::vector<double> tile_sums;                 ///< sum of m |correction|^2 by tile
  double spectral_radius = 0;                    ///< rho in use
  double weight = 1;                             ///< omega of the recurrence
  double polynomial = 1, polynomial_before = 1;  ///< T_n(1 / rho), the Chebyshev polynomial, n = steps; and T_(n-1)
  int steps = -1;                                ///< of the recurrence since its start; -1: none yet
  double plain_norm = 0;                         ///< |G(x) - x| at the substep's start,
  double first_norm = 0;                         ///< when acceleration began,
  double start_norm = 0, last_norm = 0;          ///< when the recurrence was started, and last of all
  bool given_up = false;                         ///< plain for the rest of the substep: diverged, or down at rounding
};

struct SweepScratch {
  std::vector<JacobiObject> jacobi;  ///< one an object
  ChebyshevScratch chebyshev;
  std::vector<MultigridObject> multigrid;  ///< one an object
  std::vector<PairSpring> pair_springs;    ///< of the multigrid correction
  MultigridGroups multigrid_groups;        ///< likewise
  Records predicted;                       ///< displacements as predicted, where residuals are recorded
};

}  // namespace pliant
