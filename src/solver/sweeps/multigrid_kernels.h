// The inner loops of the multigrid correction over batches [first, last) of a level, one table for each instruction set
// level as in solver/kernels.h. All give the same bits.
#pragma once

#include "math/levels.h"
#include "model/multigrid.h"
#include "model/substep.h"

namespace pliant {

/// Floats in a batch of symmetric 3 x 3 blocks: rows of sixteen, xx yy zz xy xz yz.
inline constexpr int block_floats = 6 * batch_width;
/// Floats of a slot on the finest level: a spring's block is g g^T + k I, stored as g and k.
inline constexpr int spring_floats = 4 * batch_width;

/// The values of a level at one linearisation. Records are padded to whole batches plus one zero record; w is zero.
struct MultigridValues {
  AlignedVector<float> blocks;  ///< of slots, spring_floats or block_floats each: negative off-diagonal blocks of all rows
  AlignedVector<float> diagonal;  ///< of batches: the diagonal without neighbours: inertia, contacts, anchors
  AlignedVector<float> inverse;   ///< of batches: damped inverse of the diagonal block, zero for fixed rows
  Records right, x, y;            ///< right-hand side, solution, scratch
};

/// The state about which springs are linearised.
struct LinearisedAt {
  const Record* positions = nullptr;      ///< w is the inverse mass
  const Record* displacements = nullptr;  ///< predicted, by inertia alone
  float inverse_h2 = 0;                   ///< [1/s^2]
  const float* extra = nullptr;           ///< stiffness and force of contacts, nine rows of sixteen per batch
  const char* has_extra = nullptr;        ///< batches with contacts
};

struct MultigridKernels {
  /// Computes blocks, diagonal, inverse and right-hand side of the finest level.
  void (*linearise)(const MultigridLevel& level, const LinearisedAt& at, MultigridValues& values, int first, int last);
  /// Computes blocks, diagonal and inverse of a coarser level.
  void (*coarsen)(const MultigridLevel& fine, const MultigridValues& from, bool from_springs, const MultigridLevel& level,
                  MultigridValues& values, int first, int last);
  /// out = damped inverse of the diagonal times right.
  void (*precondition)(const MultigridValues& values, const Record* right, Record* out, int first, int last);
  /// out = right - A x.
  void (*residual)(const MultigridLevel& level, const MultigridValues& values, bool springs, const Record* right,
                   const Record* x, Record* out, int first, int last);
  /// out = x + damped inverse (right - A x): Jacobi.
  void (*smooth)(const MultigridLevel& level, const MultigridValues& values, bool springs, const Record* right,
                 const Record* x, Record* out, int first, int last);
  /// out = A x; returns x . out.
  float (*apply)(const MultigridLevel& level, const MultigridValues& values, bool springs, const Record* x, Record* out,
                 int first, int last);
  /// The right-hand side of a coarser level from the finer residual, and x as its preconditioned value.
  void (*restrict_to)(const MultigridLevel& level, MultigridValues& values, const Record* residual, int first, int last);
  /// x += coarse, for each row the value of its parent.
  void (*prolong)(const MultigridLevel& level, const Record* coarse, Record* x, int first, int last);
  /// a . b.
  float (*dot)(const Record* a, const Record* b, int first, int last);
  /// direction = z + beta direction.
  void (*turn)(float beta, const Record* z, Record* direction, int first, int last);
  /// solution += alpha direction, right -= alpha image.
  void (*advance)(float alpha, const Record* direction, const Record* image, Record* solution, Record* right, int first,
                  int last);
};

PLIANT_DECLARE_LEVELS(MultigridKernels, multigrid_kernels)

}  // namespace pliant
