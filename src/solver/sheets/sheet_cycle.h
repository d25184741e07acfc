// What a sheet's bending is solved with (solver/sheets/sheet_solver.h): polynomials where a substep bends over less
// than an edge, multigrid cycles where it bends over more.
//
// With G = D^-1 h^2 K, D being the masses, the polynomials are D^-1, and D^-1 (1 - G / 4). With the first a step adds
// G to each mode, with the second G (1 - G / 4): a step neither overshoots nor adds energy as long as that is between 0
// and 1, so for G up to 1 and 4. The sums of |K_ij| in a row bound G; where they are too large for a mass, D has more
// than it. Both keep momentum and let a sheet fall freely, as K resists neither translation nor rotation.
//
// A level of a cycle is smoothed by Gauss-Seidel over the rows of a block, upwards before the coarser level and
// downwards after it; between blocks as by Jacobi, with the sum of the absolute values outside a block added to the
// diagonal, so the cycle is symmetric and never softer than the matrix (Baker, Falgout, Kolev and Yang 2011, section
// 3). Blocks depend on the object alone, so threads change no bit.
#pragma once

#include "parallel/executor.h"
#include "solver/sheets/sheet_solver.h"

namespace pliant::sheets {

/// Calls its argument for each block, on all threads.
using BlockLoop = FunctionRef<void(int blocks, FunctionRef<void(int)> body)>;

/// What acts on a sheet.
struct SheetForces {
  const Record *positions = nullptr, *displacements = nullptr;
  Vec3f gravity{};     ///< what it moves in a substep, h^2 g [m]
  float h = 0;         ///< length of a substep [s]
  float substeps = 1;  ///< that the bending is for
};

/// How P^-1 is found for a step: by so many terms of the polynomial, or by cycles if 0.
inline constexpr float largest_of_grid = 107;  ///< largest K over M in a grid, in units of B / (rho e^4): sum of |K_ij|
int terms_for(const SheetBending& sheet, float h2);
/// The masses of the finest level and its D^-1, for polynomials.
void set_diagonals(const SheetBending& sheet, const Record* positions, SheetScratch& scratch);
/// Masses of all levels, for cycles.
void set_masses(const SheetBending& sheet, const Record* positions, SheetScratch& scratch);
/// Inverses of diagonals, and the factor of the last level.
void factorise(const SheetBending& sheet, SheetScratch& scratch);
/// u, and r of the finest level; D^-1 r in `corrections` instead, for polynomials.
void find_right_hand_side(const SheetBending& sheet, const SheetForces& forces, BlockLoop loop, SheetScratch& scratch);
/// True if D^-1 has the masses alone.
bool keeps_momentum(const SheetScratch& scratch);
/// The second term of the polynomial.
void add_term(const SheetBending& sheet, BlockLoop loop, SheetScratch& scratch);
/// Makes so many cycles. `corrections` then has P^-1 r.
void solve_sheet(const SheetBending& sheet, int cycles, BlockLoop loop, SheetScratch& scratch);

}  // namespace pliant::sheets
