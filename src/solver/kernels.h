// The inner loops of a step, as one table of functions for each instruction set level. A kernel is a line in its struct and
// in each table; a level is a line in math/levels.h.
//
// All tables give the same bits and differ only in speed. The sequential one is the readable reference: plain floats, one
// constraint after another, in the same schedule.
#pragma once

#include <string>

#include "math/levels.h"
#include "model/pool.h"
#include "model/substep.h"

namespace pliant {

/// The place of a lane's correction among its batch's sixteen, in register order (math/wide.h).
inline constexpr int correction_place(int lane) { return 4 * (lane % 4) + lane / 4; }

struct ChainKernels;      // solver/sweeps/chain_kernels.h
struct MultigridKernels;  // solver/sweeps/multigrid_kernels.h
struct ContactKernels;    // solver/contact_kernels.h
struct PairKernels;       // collision/pair_kernels.h

struct StepKernels {
  /// Projects every constraint of the segments, segment by segment.
  void (*sweep)(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& arguments);

  /// The same with relaxation, and with corrections stored separately if arguments.corrections is set. The correction of a
  /// batch's `slot` and `lane` goes to record (16 (size batch + slot)) + correction_place(lane) of its pool's array.
  void (*sweep_general)(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& arguments);

  /// True if every record is finite.
  bool (*all_finite)(const Record* records, int first, int last);

  /// Ends a substep: v = (v + (d - d predicted) / h) kept, x += d. Equal to v = (x - x_start) / h, but only the solver's
  /// correction is divided. The part of d that x cannot hold goes to the rounding residue.
  void (*update)(const AdvanceArguments& arguments);

  /// Starts a substep: d = residue + h (v + gravity). Adds the positions before and after to `bounds` unless null.
  void (*predict)(const AdvanceArguments& arguments, PointBounds* bounds);

  /// update and predict in one pass over memory, for substeps without a response stage between them.
  void (*advance)(const AdvanceArguments& arguments, PointBounds* bounds);

  /// Writes the ascending indices of particles near a solid to `near`, which must have room for all; returns their number.
  int (*find_near)(const NearQuery& query, std::int32_t* near);
};

PLIANT_DECLARE_LEVELS(StepKernels, step_kernels)
const StepKernels& step_kernels_sequential();

/// All kernels of one instruction set level. A World picks one.
struct Kernels : StepKernels {
  const char* isa;  ///< name of the instruction set level
  const ChainKernels& chains;
  const MultigridKernels& multigrid;
  const ContactKernels& contacts;
  const PairKernels& pairs;
};

/// The readable reference in plain floats. Kernels without a scalar twin (multigrid, pairs) use the generic level.
const Kernels& kernels_sequential();

/// The widest kernels that this machine runs, or the named ones: a level of math/levels.h, or "sequential". Throws an Error
/// if the name is unknown or the machine cannot run them.
const Kernels& pick_kernels(const std::string& isa);

}  // namespace pliant
