// The innermost loops of the multigrid correction over batches [first, last) of a level, one table for each instruction set
// as in solver/kernels.h; all give the same bits.
#pragma once

#include "math/levels.h"
#include "model/multigrid.h"
#include "model/substep.h"

namespace pliant {

/// Floats of a batch of symmetric 3 x 3 blocks: rows of sixteen, xx yy zz xy xz yz.
inline constexpr int block_floats = 6 * batch_width;
/// Floats of a slot of the finest level: a spring's block is g g^T + k I, and this is g and k.
inline constexpr int spring_floats = 4 * batch_width;

/// The numbers of a level at one linearisation. Records have room for whole batches and one more that stays zero; w is zero.
struct MultigridValues {
  AlignedVector<float> blocks;  ///< of slots, spring_floats or block_floats each: minus what couples a row to its neighbour
  AlignedVector<float> diagonal;  ///< of batches: what holds a row beside its neighbours: inertia, contacts, anchors
  AlignedVector<float> inverse;   ///< of batches: damped inverse of the whole diagonal block, zero where nothing can move
  Records right, x, y;            ///< right-hand side, solution, scratch
};

/// What springs are linearised about.
struct LinearisedAt {
  const Record* positions = nullptr;      ///< w the inverse mass
  const Record* displacements = nullptr;  ///< as predicted: where inertia alone has them
  float inverse_h2 = 0;                   ///< [1/s^2]
  const float* extra = nullptr;           ///< block and force of contacts, nine rows of sixteen a batch,
  const char* has_extra = nullptr;        ///< where this is set
};

struct MultigridKernels {
  /// Blocks, diagonal, inverse and right-hand side of the finest level.
  void (*linearise)(const MultigridLevel& level, const LinearisedAt& at, MultigridValues& values, int first, int last);
  /// Blocks, diagonal and inverse of a coarser one.
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
  /// The right-hand side of a coarser level from the finer's residual, and x as precondition has it.
  void (*restrict_to)(const MultigridLevel& level, MultigridValues& values, const Record* residual, int first, int last);
  /// x += coarse, each row its parent's.
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
