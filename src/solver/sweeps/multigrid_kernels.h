// The inner loops of the multigrid correction over batches [first, last) of a level, one table of functions for each
// instruction set level as in solver/kernels.h. All tables give the same bits.
#pragma once

#include "math/levels.h"
#include "model/multigrid.h"
#include "model/substep.h"

namespace pliant {

/// Floats of sixteen symmetric 3 x 3 blocks: sixteen xx, then yy, zz, xy, xz, yz.
inline constexpr int block_floats = 6 * batch_width;
/// Floats of sixteen springs on the finest level: the block of a spring is g g^T + k I, stored as g and k.
inline constexpr int spring_floats = 4 * batch_width;

/// Matrix and vectors of a level in one solve. Records are padded to whole batches plus one zero record; their w is
/// zero.
struct MultigridValues {
  /// Negative off-diagonal blocks of all rows by slot: spring_floats or block_floats each.
  AlignedVector<float> blocks;
  /// Diagonal blocks of each batch without neighbours' part: inertia, contacts, anchors.
  AlignedVector<float> diagonal;
  AlignedVector<float> inverse;  ///< damped inverses of each batch's diagonal blocks, zero for fixed rows
  Records right, x, y;           ///< right-hand side, solution, scratch
  /// The blocks again, as records by row_of(slot, lane), for sums of the next level: g and k of springs; xx yy zz xy of
  /// blocks, and xz yz in the second half. A zero record follows the last slot. Empty on the coarsest level.
  Records terms;
};

/// The positions at which springs are linearised.
struct LinearisedAt {
  const Record* positions = nullptr;      ///< positions at the substep's start; w is the inverse mass
  const Record* displacements = nullptr;  ///< displacements predicted by inertia alone
  float inverse_h2 = 0;                   ///< 1 / h^2, h being the substep [1/s^2]
  const float* extra = nullptr;     ///< matrix terms of contacts: stiffness and force, nine rows of sixteen per batch
  const char* has_extra = nullptr;  ///< for each batch, 1 if it has contacts
};

struct MultigridKernels {
  /// Computes blocks, diagonal, inverse and right-hand side of the finest level.
  void (*linearise)(const MultigridLevel& level, const LinearisedAt& at, MultigridValues& values, int first, int last);
  /// Computes blocks, diagonal and inverse of a coarser level.
  void (*coarsen)(const MultigridLevel& fine, const MultigridValues& from, bool from_springs,
                  const MultigridLevel& level, MultigridValues& values, int first, int last);
  /// out = damped inverse of the diagonal blocks times `right`.
  void (*precondition)(const MultigridValues& values, const Record* right, Record* out, int first, int last);
  /// out = right - A x.
  void (*residual)(const MultigridLevel& level, const MultigridValues& values, bool springs, const Record* right,
                   const Record* x, Record* out, int first, int last);
  /// One Jacobi pass: out = x + damped inverse (right - A x).
  void (*smooth)(const MultigridLevel& level, const MultigridValues& values, bool springs, const Record* right,
                 const Record* x, Record* out, int first, int last);
  /// out = A x; returns the dot product x . out.
  float (*apply)(const MultigridLevel& level, const MultigridValues& values, bool springs, const Record* x, Record* out,
                 int first, int last);
  /// out = diagonal blocks times x: A x in rows whose neighbours have the same x.
  void (*apply_diagonal)(const MultigridValues& values, const Record* x, Record* out, int first, int last);
  /// Sums the finer level's residual to this level's right-hand side; sets x to the damped inverse times that.
  void (*restrict_to)(const MultigridLevel& level, MultigridValues& values, const Record* residual, int first,
                      int last);
  /// Prolongation: adds to each row of x the value of its parent row in `coarse`.
  void (*prolong)(const MultigridLevel& level, const Record* coarse, Record* x, int first, int last);
  /// Returns the dot product a . b.
  float (*dot)(const Record* a, const Record* b, int first, int last);
  /// direction = z + beta direction.
  void (*turn)(float beta, const Record* z, Record* direction, int first, int last);
  /// solution += alpha direction, right -= alpha image.
  void (*advance)(float alpha, const Record* direction, const Record* image, Record* solution, Record* right, int first,
                  int last);
};

PLIANT_DECLARE_LEVELS(MultigridKernels, multigrid_kernels)

}  // namespace pliant
