// One multigrid cycle of a sheet's bending (solver/sheets/sheet_solver.h).
//
// A level is smoothed by Gauss-Seidel over the rows of a block, upwards before the coarser level and downwards after
// it; between blocks as by Jacobi, with the sum of the absolute values outside a block added to the diagonal, so the
// cycle is symmetric and never softer than the matrix (Baker, Falgout, Kolev and Yang 2011, section 3). Blocks depend
// on the object alone, so threads change no bit.
#pragma once

#include "parallel/executor.h"
#include "solver/sheets/sheet_solver.h"

namespace pliant {

/// Calls its argument for each block, on all threads.
using BlockLoop = FunctionRef<void(int blocks, FunctionRef<void(int)> body)>;

/// What acts on a sheet.
struct SheetForces {
  const Record *positions = nullptr, *displacements = nullptr;
  Vec3f gravity{};     ///< what it moves in a substep, h^2 g [m]
  float h = 0;         ///< length of a substep [s]
  float substeps = 1;  ///< that the bending is for
};

/// Masses of all levels.
void set_masses(const SheetBending& sheet, const Record* positions, SheetScratch& scratch);
/// Inverses of diagonals, and the factor of the last level.
void factorise(const SheetBending& sheet, SheetScratch& scratch);
/// u, and r of the finest level.
void find_right_hand_side(const SheetBending& sheet, const SheetForces& forces, BlockLoop loop, SheetScratch& scratch);
/// Makes so many cycles. `corrections` then has P^-1 r.
void solve_sheet(const SheetBending& sheet, int cycles, BlockLoop loop, SheetScratch& scratch);

}  // namespace pliant
