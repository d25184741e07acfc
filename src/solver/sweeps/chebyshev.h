// Chebyshev semi-iterative acceleration (Wang 2015) of sweeps with real, or nearly real, eigenvalues.
//
//   x_(k+1) = omega_(k+1) (G(x_k) - x_(k-1)) + x_(k-1),   omega = 1 | 2 / (2 - rho^2) | 4 / (4 - rho^2 omega) | ...
//
// G is one iteration of the sweep, rho its spectral radius. x contains displacements and multipliers, because their linear
// relation must persist. The first iterations of a substep are plain.
//
// rho is estimated in each substep, so that the State needs no extra data. The ratio of the last two
// plain corrections |G(x) - x| (in the mass norm) is a lower bound, which is safe: an overestimate
// of rho costs far more. n steps should reduce corrections by T_n(1 / rho). If they are e times
// larger, an eigenvalue lambda lies above rho, with T_n(lambda / rho) >= e: the recurrence restarts
// with that lambda (Hageman and Young, Applied Iterative Methods, 1981, chapter 5), still a lower
// bound. If corrections grow, or stagnate at rounding, the rest of the substep is plain.
//
// Gauss-Seidel in natural order has suitable eigenvalues too, but its matrix is
// so far from normal that rounding errors grow without bound; World rejects it.
#pragma once

#include <utility>
#include <vector>

#include "model/model.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// One float per lane for each pool, as in Workspace::multipliers: [object][pool].
using LaneValues = std::vector<std::vector<AlignedVector<float>>>;

/// x_k as displacements and multipliers.
struct ChebyshevIterate {
  Records displacements;
  LaneValues multipliers;
  std::vector<double> volumes;
};

/// The recurrence's state in this substep. Norms are those of plain corrections, |G(x) - x|.
struct ChebyshevRecurrence {
  double spectral_radius = 0;                    ///< rho in use
  double weight = 1;                             ///< omega
  double polynomial = 1, polynomial_before = 1;  ///< T_n(1 / rho), the Chebyshev polynomial, n = steps; and T_(n-1)
  int steps = -1;                                ///< steps since the recurrence's start; -1: not started
  double plain_norm = 0;                         ///< norm of the first correction of the substep
  double first_norm = 0;                         ///< norm when acceleration started
  double start_norm = 0, last_norm = 0;          ///< norm when the recurrence was started, and the latest norm
  bool given_up = false;                         ///< plain for the rest of the substep: diverged, or at rounding
};

/// The last two iterates of a group and its recurrence.
struct ChebyshevScratch : SweepScratch {
  ChebyshevIterate before, older;  ///< x_k and x_(k-1)
  ChebyshevRecurrence recurrence;
  std::vector<double> tile_sums;  ///< sum of m |correction|^2 by tile
  std::vector<std::vector<Record>>
      touching;  ///< by tile: displacements of particles in contact, while others are extrapolated
  std::vector<std::pair<int, Record>> touching_points;  ///< the same for contacts of edges, triangles and surfaces

  void prepare(const SweepSetup& setup, int object) override;
};

/// Call before an iteration of the current group: stores the iterate.
void keep_iterate(Substep& s, int iteration);

/// Call after the sweep and before contacts.
void accelerate(Substep& s, int iteration);

}  // namespace pliant
