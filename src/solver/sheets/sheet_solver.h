// The bending of flat sheets, once a substep between contact search and the iterations (model/sheet_bending.h).
//
//   u = d - a,  a = h^2 g          what has been predicted, without gravity
//   r = M a + h^2 f(x + u)         f = -K (x + u), linear, so no fold makes it stiffer than K
//   d = u + P^-1 r                 P: a multigrid cycle on M + h^2 K
//
// Gravity is part of r where particles are pinned: at rest without stretch and contact d = 0 means f = -M g, whatever P
// is. So the sag depends on neither cycles nor substeps. P is nowhere softer than M + h^2 K, hence the step never adds
// energy to bending. Damping of bending adds beta h to the h^2 of K in P and in u. A piece without pins keeps its
// momentum: P conserves it only where its solve is exact. P knows no contacts: sheet_contacts.h finds their forces.
#pragma once

#include <vector>

#include "model/sheet_bending.h"
#include "solver/momentum.h"

namespace pliant {

struct Substep;

/// The values of one level in a substep.
struct SheetLevelScratch {
  std::vector<float> mass;     ///< of each row, on the finest level 0 if it is fixed [kg]
  std::vector<float> heavy;    ///< of coarse levels: what water and new pins add to it [kg]
  std::vector<float> entries;  ///< of coarse levels, by pattern: M_ij + h^2 K_ij [kg]
  std::vector<float> beyond;   ///< of each pattern: sum over other blocks of |M_ij + h^2 K_ij| [kg]
  std::vector<float> inverse;  ///< 1 / (M_ii + heavy + h^2 K_ii + beyond); 0 if it is fixed [1/kg]
  Records right, x, before;    ///< right-hand side, solution, and the solution before the second sweep
};

/// What the bending of one object needs in a substep. Nothing of it lasts for the next frame.
struct SheetScratch {
  float h2 = 0;                           ///< what K is multiplied by [s^2]
  std::vector<SheetLevelScratch> levels;  ///< one for each level
  Records moved, corrections;             ///< multiple of u of each row, and P^-1 r [m]
  Records direction, product;             ///< of conjugate gradients
  std::vector<double> sums;               ///< of blocks
  std::vector<char> is_wide;              ///< of each block: nonzero if rounding would blur what its rows share
  std::vector<double> factor;             ///< Cholesky factor of the last level, by rows
  std::vector<char> is_pinned;            ///< of each piece: 1 if it has a particle that is pinned or held
  std::vector<RigidSums> momentum;        ///< of each piece
};

/// Bends all sheets of the group.
void bend_sheets(Substep& s);

/// True if an object of the group bends as a sheet.
bool has_sheets(const Substep& s);

}  // namespace pliant
