// Bending of flat sheets: one quadratic energy of the whole sheet instead of one constraint a hinge, unless edges are
// so long that they fold one by one (sheet_choice.h).
//
// A sweep over hinges does not converge where edges are shorter than the bending length of a substep,
// l = (h^2 B / rho)^(1/4): it sags too much by a factor 1 + 2.3 (l / edge)^4. A substep solves
// M + h^2 K for the whole sheet instead (solver/sheets/sheet_solver.h), so the sag depends on neither the mesh nor the
// substeps. K is constant, the same for x, y and z:
//
//   energy = sum over vertices of B A / 2 (kxx^2 + 2 kxy^2 + kzz^2)
//
// A is a vertex's area, k the curvature of the quadratic that fits the offsets of the vertices around it best, in the
// rest plane, weighted by 1 / distance^2. The curvature of a sheet that hardly stretches is a multiple of its normal,
// so each component of k has three coordinates, and K applies to each coordinate alike. docs/internals/bending.md
// compares this energy with others.
//
// The solve is a multigrid cycle or, where a substep bends over less than an edge, a polynomial of one or two terms.
// Each level keeps a quarter to a third of the vertices of the finer one and interpolates linearly between them. Coarse
// stiffness and mass are Galerkin products, so a cycle is never softer than M + h^2 K, and moves and turns what no
// force bends as it should: with lumped coarse masses a sheet fell at 0.8 g.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "model/gather_constraints.h"
#include "pliant/scene.h"
#include "pliant/state.h"

namespace pliant {

/// Rows of a level that one thread smooths one after another; rows of other blocks have the values of before.
inline constexpr int sheet_block = 1024;
/// Rows at which coarsening ends, and the largest number that is solved directly.
inline constexpr int coarsest_sheet_rows = 32;

/// The matrices of one level in compressed rows. Rows with the same offsets and, but for rounding, the same values
/// share a pattern: a grid of 256 x 256 has 1 102 of them, which a cache holds. A pattern has first the columns below
/// the row in its block, then those above it in its block, then those of other blocks, each part ascending.
struct SheetLevel {
  int rows = 0;
  std::vector<std::int32_t> pattern;                ///< of each row
  std::vector<std::int32_t> begin, above, outside;  ///< of each pattern: its first entry, and the first of other parts
  std::vector<float> diagonal;                      ///< of each pattern: K_ii [N/m]
  std::vector<std::int32_t> offset;                 ///< of each entry: the column less the row
  std::vector<float> stiffness;                     ///< of each entry; the diagonal has none [N/m]
  std::vector<float> mass_between;                  ///< of each entry, of coarse levels alone [kg]
  std::vector<float> mass;                          ///< of each row, of the masses that are given [kg]
  std::vector<char> is_fixed;                       ///< 1: a pinned vertex, or one without triangles
  std::vector<std::array<std::int32_t, 3>> parent;  ///< rows of the next level between which a row is interpolated
  std::vector<std::array<float, 3>> share;          ///< and their weights; 0 where there are fewer
  std::vector<std::int32_t> child_begin, child;     ///< for each row of the next level, the rows that it moves
  std::vector<float> child_share;

  int patterns() const { return static_cast<int>(above.size()); }
  int blocks() const { return (rows + sheet_block - 1) / sheet_block; }
};

/// The bending energy of one object, and its levels, finest first; none if its hinges are projected instead.
struct SheetBending {
  std::vector<SheetLevel> levels;
  std::vector<std::int32_t> piece;  ///< of each vertex; -1: it has no triangle
  std::vector<char> is_held;        ///< of each vertex: 1 where a rigid attachment holds it; empty: none is
  int pieces = 0;
  float damping_time = 0;  ///< damping over stiffness [s]
  float stiffness = 0;     ///< B / (rho e^4), e the mean edge, or of the finest parts if it is more there [1/s^2]

  bool is_used() const { return !levels.empty(); }
};

/// The least substeps a frame of a sheet whose substeps follow the State (solver/substep_law.h).
inline constexpr int least_substeps_of_sheets = 12;

/// True if the hinges of an object are those of a flat sheet that is too fine for them in substeps of `h` seconds: its
/// hinges have the compliances of a material and a flat rest shape without plasticity. All inner edges have one hinge,
/// of much the same stiffness as those beside it: seams that bend freely, creases and edges of three triangles keep
/// hinges. `h` of several iterations is that of a substep over the square root of their number.
bool bends_as_sheet(const Object& object, double h);

/// By what share a sheet of hinges bends too far in substeps of `h` seconds; 0 if it bends as a sheet, or has no hinges
/// with compliances. It is 2.3 h^2 B / (rho e^4), measured with one sweep a substep (docs/internals/bending.md).
double excess_of_hinges(const Object& object, double h);

/// What the hinges of a sheet say of its material.
struct SheetFacts {
  std::vector<double> rigidity;  ///< B at each particle: the mean of its hinges; 0 without one [N m]
  double stiffness = 0;          ///< SheetBending::stiffness
  float damping_time = 0;
};
SheetFacts facts_of_sheet(const Object& object);

/// Builds the energy and levels. `place`: storage index of each particle of the object; `positions`: in storage order,
/// inverse mass in w; `held`: held_by_targets (model/attachments.h). Particles that a rigid attachment holds are
/// clamped as pinned ones are. Reads no constraints of the object.
SheetBending build_sheet(const Object& object, const SheetFacts& facts, const std::vector<int>& place,
                         std::vector<Record> positions, const std::vector<int>& held);

// ------------------------------------------------------------------------------------------------ parts of the above

/// A sheet being built.
struct SheetDraft {
  std::vector<Vec3d> rest, normal;       ///< of each row; normals are unit vectors
  std::vector<std::vector<int>> around;  ///< rows joined to each row by an edge
  std::vector<char> is_fixed;
};

/// Symmetric matrices K and M by rows, with their diagonals.
struct SparseRows {
  struct Entry {
    int column = 0;
    double stiffness = 0, mass = 0;
  };
  std::vector<std::vector<Entry>> row;  ///< columns ascending
};

/// Appends a matrix to a level as patterns: the first of rows that differ by rounding alone. `of_masses`: with M_ij.
void append_patterns(const SparseRows& matrix, bool of_masses, SheetLevel& level);
/// Appends the levels below a draft of the finest one.
void append_levels(SheetDraft draft, SparseRows stiffness, std::vector<SheetLevel>& levels);

}  // namespace pliant
