// Chebyshev semi-iterative acceleration (Wang 2015) of any sweep whose iteration has real eigenvalues, or nearly.
//
//   x_(k+1) = omega_(k+1) (G(x_k) - x_(k-1)) + x_(k-1),   omega = 1 | 2 / (2 - rho^2) | 4 / (4 - rho^2 omega) | ...
//
// G is one iteration of the sweep, rho its spectral radius; x_(k+1) stands for displacements and multipliers alike, since
// the relation between the two is linear and must go on holding. The first iterations of a substep are plain.
//
// rho is estimated in each substep, so that nothing is carried that a State would have to hold. The ratio of the last
// two plain corrections |G(x) - x| (in the norm of the masses) is below rho, as it should be: too large a rho costs far
// more than too small a one. n steps should then bring corrections down by T_n(1 / rho). Where they are e times larger than
// that, some eigenvalue lambda lies above rho, with T_n(lambda / rho) >= e: the recurrence starts over with that lambda
// (Hageman and Young, Applied Iterative Methods, 1981, chapter 5), still from below. Where corrections grow, or stand still
// because they are mere rounding, the rest of the substep is plain.
//
// Over Gauss-Seidel in natural order the eigenvalues are as good, but the matrix is so far from normal that rounding grows
// without bound: World refuses it.
#pragma once

#include <vector>

#include "model/model.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// One float a lane for each pool, as Workspace::multipliers has them: [object][pool].
using LaneValues = std::vector<std::vector<AlignedVector<float>>>;

/// x_k as displacements, with its multipliers.
struct ChebyshevIterate {
  Records displacements;
  LaneValues multipliers;
  std::vector<double> volumes;
};

/// Where the recurrence stands in this substep. Norms are those of plain corrections, |G(x) - x|.
struct ChebyshevRecurrence {
  double spectral_radius = 0;                    ///< rho in use
  double weight = 1;                             ///< omega
  double polynomial = 1, polynomial_before = 1;  ///< T_n(1 / rho), the Chebyshev polynomial, n = steps; and T_(n-1)
  int steps = -1;                                ///< since its start; -1: it has not started
  double plain_norm = 0;                         ///< at the substep's start,
  double first_norm = 0;                         ///< when acceleration began,
  double start_norm = 0, last_norm = 0;          ///< when the recurrence was started, and last
  bool given_up = false;                         ///< plain for the rest of the substep: diverged, or down at rounding
};

/// The last two iterates of a group and its recurrence.
struct ChebyshevScratch : SweepScratch {
  ChebyshevIterate before, older;  ///< x_k and x_(k-1)
  ChebyshevRecurrence recurrence;
  std::vector<double> tile_sums;  ///< sum of m |correction|^2 by tile
  std::vector<std::vector<Record>>
      touching;  ///< by tile: displacements of particles in contact, while others are extrapolated

  void prepare(const SweepSetup& setup, int object) override;
};

/// Before an iteration of the group under way: keeps the iterate.
void keep_iterate(Substep& s, int iteration);

/// After its sweep and before its contacts.
void accelerate(Substep& s, int iteration);

}  // namespace pliant
