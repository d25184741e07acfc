// The innermost loops of a step, behind one table of functions for each instruction set. A kernel is a line in its struct and one
// in each table of it; a level is a line in math/levels.h.
//
// Every table gives the same bits; they differ in speed alone. The sequential one is the readable reference: plain floats,
// one constraint after the other, in the order of the same schedule.
#pragma once

#include <string>

#include "math/levels.h"
#include "model/pool.h"
#include "model/substep.h"

namespace pliant {

/// Where a lane's correction lies among its batch's sixteen: as registers hold them (math/wide.h).
inline constexpr int correction_place(int lane) { return 4 * (lane % 4) + lane / 4; }

struct ChainKernels;      // solver/sweeps/chain_kernels.h
struct MultigridKernels;  // solver/sweeps/multigrid_kernels.h
struct ContactKernels;    // solver/contact_kernels.h
struct PairKernels;       // collision/pair_kernels.h

struct StepKernels {
  /// Projects every constraint of the segments, one segment after the other.
  void (*sweep)(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& arguments);

  /// The same with relaxation, and with corrections written aside where arguments.corrections says so. The correction of a
  /// batch's `slot` and `lane` goes to record (16 (size batch + slot)) + correction_place(lane) of its pool's array.
  void (*sweep_general)(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& arguments);

  /// Whether every record is finite.
  bool (*all_finite)(const Record* records, int first, int last);

  /// Ends a substep: v = (v + (d - d predicted) / h) kept, x += d. Equal to v = (x - x_start) / h, but what is divided is
  /// the solver's own correction. The part of d that x can't hold goes to the remainder.
  void (*update)(const AdvanceArguments& arguments);

  /// Begins a substep: d = remainder + h (v + gravity). Adds the places before and after to `bounds` where it is not null.
  void (*predict)(const AdvanceArguments& arguments, PointBounds* bounds);

  /// update, then predict, in one pass over memory: for where nothing responds in between.
  void (*advance)(const AdvanceArguments& arguments, PointBounds* bounds);

  /// Writes the particles near a solid to `near`, ascending, and returns how many; room for all is needed.
  int (*find_near)(const NearQuery& query, std::int32_t* near);
};

PLIANT_DECLARE_LEVELS(StepKernels, step_kernels)
const StepKernels& step_kernels_sequential();

/// All that is compiled for one instruction set. A World picks one and hands it on.
struct Kernels : StepKernels {
  const char* isa;  ///< its name
  const ChainKernels& chains;
  const MultigridKernels& multigrid;
  const ContactKernels& contacts;
  const PairKernels& pairs;
};

/// The readable reference in plain floats. What has no twin there (multigrid, pairs) is of the generic level.
const Kernels& kernels_sequential();

/// The widest kernels that this machine runs, or those named: a level of math/levels.h, or "sequential". Throws Error where the
/// name is unknown or the machine cannot run them.
const Kernels& pick_kernels(const std::string& isa);

}  // namespace pliant
