// Chebyshev semi-iterative acceleration (Wang 2015) of sweeps with real, or nearly real, eigenvalues.
//
//   x_(k+1) = omega_(k+1) (G(x_k) - x_(k-1)) + x_(k-1),   omega = 1 | 2 / (2 - rho^2) | 4 / (4 - rho^2 omega) | ...
//
// G is one iteration of the sweep, rho its spectral radius. x consists of displacements and multipliers, whose linear
// relation must persist. The first iterations of a substep are plain, that is, not extrapolated.
//
// rho is estimated again in each substep, so that the State needs no additional data. The ratio of the last two
// corrections |G(x) - x| of plain iterations (in the mass norm) is a lower bound. That is safe: an overestimate of rho
// costs far more. n steps should reduce corrections by T_n(1 / rho). If they are e times larger, an eigenvalue lambda
// lies above rho, with T_n(lambda / rho) >= e. Then the recurrence restarts with that lambda, still a lower bound
// (Hageman and Young, Applied Iterative Methods, 1981, chapter 5). If corrections grow, or stagnate at rounding, the
// rest is plain.
//
// The eigenvalues of Gauss-Seidel in natural order would allow acceleration too, but its matrix is so far from normal
// that rounding errors grow without bound; World rejects this combination.
#pragma once

#include <utility>
#include <vector>

#include "model/model.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// Multipliers as in Workspace::multipliers: [object][pool], one float per lane.
using LaneValues = std::vector<std::vector<AlignedVector<float>>>;

/// An iterate x_k: displacements and multipliers.
struct ChebyshevIterate {
  Records displacements;
  LaneValues multipliers;
  std::vector<double> volumes;
};

/// The state of the recurrence in this substep. Norms are those of sweep corrections |G(x) - x|.
struct ChebyshevRecurrence {
  double spectral_radius = 0;                    ///< rho, the spectral radius in use
  double weight = 1;                             ///< omega of the last extrapolation
  double polynomial = 1, polynomial_before = 1;  ///< Chebyshev polynomials T_n(1 / rho) and T_(n-1)(1 / rho), n = steps
  int steps = -1;                                ///< n, steps since the recurrence was started; -1: not started
  double plain_norm = 0;                         ///< norm of the substep's first correction
  double first_norm = 0;                         ///< norm when acceleration began
  double start_norm = 0, last_norm = 0;          ///< norm when the recurrence was (re)started; last norm
  bool given_up = false;  ///< true: the rest of the substep has plain sweeps, after divergence or at rounding error
};

/// The last two iterates of a sweep group, and its recurrence.
struct ChebyshevScratch : SweepScratch {
  ChebyshevIterate before, older;  ///< iterates x_k and x_(k-1)
  ChebyshevRecurrence recurrence;
  std::vector<double> tile_sums;  ///< sum of m |correction|^2 over each tile
  /// For each tile, saved displacements of particles in contact, which are not extrapolated.
  std::vector<std::vector<Record>> touching;
  std::vector<std::pair<int, Record>> touching_points;  ///< saved displacements at other contacts

  void prepare(const SweepSetup& setup, int object) override;
};

/// Stores the iterate of the current sweep group; call it before each of its iterations.
void keep_iterate(Substep& s, int iteration);

/// Extrapolates the current sweep group; call it after the sweep and before contacts.
void accelerate(Substep& s, int iteration);

}  // namespace pliant
