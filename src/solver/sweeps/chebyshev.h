// Chebyshev semi-iterative acceleration (Wang 2015) of any sweep whose iteration has real eigenvalues, or nearly.
//
//   x_(k+1) = omega_(k+1) (G(x_k) - x_(k-1)) + x_(k-1),   omega = 1 | 2 / (2 - rho^2) | 4 / (4 - rho^2 omega) | ...
//
// G is one iteration of the sweep, rho its spectral radius; x_(k+1) stands for displacements and multipliers alike, since
// the relation between the two is linear and must go on holding. The first iterations of a substep are plain.
//
// rho is estimated anew in each substep, so that nothing is carried that a State would have to hold. The ratio of the last
// two plain corrections |G(x) - x| (in the norm of the masses) is below rho, as it should be: too large a rho costs far
// more than too small a one. n steps should then bring corrections down by T_n(1 / rho). Where they are e times larger than
// that, some eigenvalue lambda lies above rho, with T_n(lambda / rho) >= e: the recurrence starts over with that lambda
// (Hageman and Young, Applied Iterative Methods, 1981, chapter 5), still from below. Where corrections grow, or stand still
// because they are mere rounding, the rest of the substep is plain.
//
// Over Gauss-Seidel in natural order the eigenvalues are as good, but the matrix is so far from normal that rounding grows
// without bound: World refuses it.
#pragma once

#include "model/model.h"
#include "solver/sweeps/scratch.h"

namespace pliant {

struct Substep;
struct Workspace;

/// Makes room for an object; multipliers as the workspace has them.
void prepare_chebyshev(const Model& model, int object, const Workspace& workspace, ChebyshevScratch& scratch);

/// Before an iteration: keeps the iterate.
void keep_iterate(Substep& s, int iteration);

/// After its sweep and before its contacts.
void accelerate(Substep& s, int iteration);

}  // namespace pliant
